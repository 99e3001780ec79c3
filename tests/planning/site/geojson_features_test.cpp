#include "site/geojson_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/geometry/degree.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using nlohmann::json;

const LocalFrame kSite(geo_point_from_degrees(48.1, 11.6, 520.0));

json read(const GeoJsonFeatures& features) { return json::parse(features.text()); }

TEST(GeoJsonFeatures, AFileWithoutFeaturesIsACollection) {
  const json wgs84 = read({kSite, FileFrame::kWgs84}), enu = read({kSite, FileFrame::kEnu});
  EXPECT_EQ(wgs84, json::parse(R"({"type": "FeatureCollection", "features": []})"));
  EXPECT_EQ(enu, json::parse(R"({"type": "FeatureCollection", "frame": "enu", "features": []})"));
}

TEST(GeoJsonFeatures, MetresAreRoundedToMicrometres) {
  GeoJsonFeatures features(kSite, FileFrame::kEnu);
  features.point({1.23456789, -0.1}, {{"name", "hydrant"}});
  EXPECT_EQ(read(features)["features"], json::parse(R"([{"type": "Feature", "properties": {"name": "hydrant"},
                "geometry": {"type": "Point", "coordinates": [1.234568, -0.1]}}])"));
  EXPECT_NE(features.text().find("[1.234568,-0.1]"), std::string::npos) << "no digits behind";
}

TEST(GeoJsonFeatures, DegreesAreThoseOfThePlaneOfTheOrigin) {
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(4000, -3000), Eigen::Vector2d(-9000, 100)}) {
    GeoJsonFeatures features(kSite, FileFrame::kWgs84);
    features.point(p, json::object());
    const json at = read(features)["features"][0]["geometry"]["coordinates"];
    // Longitude first; a reader knows no height and takes that of the origin.
    const Eigen::Vector3d enu =
        kSite.to_enu({at[1].get<double>() * kDegree, at[0].get<double>() * kDegree, kSite.origin().altitude});
    EXPECT_LT((enu.head<2>() - p).norm(), 2e-4) << p.transpose();
  }
}

TEST(GeoJsonFeatures, LinesAreOpenAndPolygonsAreRings) {
  GeoJsonFeatures features(kSite, FileFrame::kEnu);
  features.line({{0, 0}, {10, 0}, {10, 5}}, {{"row", 3}});
  features.polygon({{0, 0}, {4, 0}, {0, 4}}, json::object());
  features.polygon({}, json::object());
  const json all = read(features)["features"];
  EXPECT_EQ(all[0]["geometry"],
            json::parse(R"({"type": "LineString", "coordinates": [[0, 0], [10, 0], [10, 5]]})"));
  EXPECT_EQ(all[0]["properties"]["row"], 3);
  EXPECT_EQ(all[1]["geometry"],
            json::parse(R"({"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [0, 4], [0, 0]]]})"));
  EXPECT_EQ(all[2]["geometry"]["coordinates"], json::parse("[[]]"));
}

TEST(GeoJsonFeatures, TheGroundOfAMissionIsAllButItsRows) {
  Mission mission;
  mission.rows = {{1, {{0, 0}, {9, 0}}}};
  mission.keep_out = {{{0, 5}, {4, 5}, {0, 9}}};
  mission.boundary = {{-50, -50}, {50, -50}, {0, 50}};
  mission.starts = {{testing::name(1), {1, 2}}, {std::nullopt, {3, 4}}};
  GeoJsonFeatures features(kSite, FileFrame::kEnu);
  features.ground(mission);
  const json all = read(features)["features"];
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0]["properties"], json::parse(R"({"keep_out": true})"));
  EXPECT_EQ(all[0]["geometry"]["coordinates"][0][1], json::parse("[4, 5]"));
  EXPECT_EQ(all[1]["properties"]["boundary"], true);
  EXPECT_EQ(all[2]["properties"], json::parse(R"({"start": "r2"})"));
  EXPECT_EQ(all[2]["geometry"], json::parse(R"({"type": "Point", "coordinates": [1, 2]})"));
  EXPECT_EQ(all[3]["properties"], json::parse(R"({"start": true})"));
}

TEST(GeoJsonFeatures, EachFeatureHasALine) {
  GeoJsonFeatures features(kSite, FileFrame::kWgs84);
  for (int k = 0; k < 5; ++k) features.point({k, 0}, {{"name", "two\nlines"}});
  const std::string text = features.text();
  EXPECT_EQ(std::ranges::count(text, '\n'), 7) << "one before them, one behind the end";
  EXPECT_TRUE(text.ends_with("]}\n"));
}

}  // namespace
}  // namespace fleetmap::planning
