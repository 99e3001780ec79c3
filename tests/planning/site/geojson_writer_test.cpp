#include "fleetmap/planning/site/geojson_writer.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fleetmap/planning/site/geojson.hpp"
#include "planning/sites.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::planning {
namespace {

const LocalFrame kSouthernSite(geo_point_from_degrees(-33.9, 18.4, 25.0));

Mission drawing() {
  testing::SiteSpec spec;
  spec.width = spec.depth = 80.0;
  spec.turned = 0.3;
  Mission mission = testing::site(spec);
  mission.boundary = {{-90, -90}, {190, -90}, {190, 190}, {-90, 190}};
  mission.starts = {{testing::name(0), {-8, -8}}, {std::nullopt, {-12, -8}}};
  return mission;
}

void expect_same(const Polyline& a, const Polyline& b, double error) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_LT((a[k] - b[k]).norm(), error);
}

TEST(GeoJsonWriter, AMissionIsReadFromItsFileAsItWas) {
  const fleetmap::testing::TemporaryFolder folder;
  const Mission mission = drawing();
  for (const auto& [frame, error] : {std::pair{FileFrame::kEnu, 1.5e-6}, {FileFrame::kWgs84, 2e-4}}) {
    const auto file = folder.path() / "site.geojson";
    ASSERT_TRUE(write_geojson(file, mission, kSouthernSite, frame));
    const auto again = read_geojson(file, kSouthernSite);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->rows.size(), mission.rows.size());
    for (std::size_t k = 0; k < mission.rows.size(); ++k) {
      EXPECT_EQ(again->rows[k].id, mission.rows[k].id);
      expect_same(again->rows[k].waypoints, mission.rows[k].waypoints, error);
    }
    ASSERT_EQ(again->keep_out.size(), mission.keep_out.size());
    for (std::size_t k = 0; k < mission.keep_out.size(); ++k)
      expect_same(again->keep_out[k], mission.keep_out[k], error);
    ASSERT_TRUE(again->boundary);
    expect_same(*again->boundary, *mission.boundary, error);
    ASSERT_EQ(again->starts.size(), 2u);
    EXPECT_EQ(again->starts[0].agent, testing::name(0));
    EXPECT_FALSE(again->starts[1].agent);
    expect_same({again->starts[1].at}, {mission.starts[1].at}, error);
  }
}

TEST(GeoJsonWriter, RowsComeFirstWithTheirNumbers) {
  Mission mission;
  mission.rows = {{7, {{0, 0}, {9, 0}}}, {3, {{0, 5}, {9, 5}}}};
  mission.keep_out = {{{0, 1}, {4, 1}, {0, 2}}};
  const auto json = nlohmann::json::parse(to_geojson(mission, kSouthernSite, FileFrame::kEnu));
  EXPECT_EQ(json["frame"], "enu");
  ASSERT_EQ(json["features"].size(), 3u);
  EXPECT_EQ(json["features"][0]["properties"], nlohmann::json::parse(R"({"row": 7})"));
  EXPECT_EQ(json["features"][1]["properties"], nlohmann::json::parse(R"({"row": 3})"));
  EXPECT_EQ(json["features"][2]["geometry"]["type"], "Polygon");
  EXPECT_FALSE(nlohmann::json::parse(to_geojson(mission, kSouthernSite)).contains("frame"))
      << "WGS84, as the RFC has it";
}

TEST(GeoJsonWriter, UnwritableFileIsNamed) {
  const fleetmap::testing::TemporaryFolder folder;
  const auto file = folder.path() / "no" / "site.geojson";
  const Status written = write_geojson(file, drawing(), kSouthernSite);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, file.string() + ": cannot be written: No such file or directory");
}

}  // namespace
}  // namespace fleetmap::planning
