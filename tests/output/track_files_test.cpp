#include "fleetmap/output/track_files.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geometry/geoid_file.hpp"
#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// r1 at the origin and 100 m north of it, r2 at one place, and a node of r2 that has none.
class TrackFiles : public ::testing::Test {
 protected:
  TrackFiles() {
    add("r1", 0, 0, 0.0);
    add("r1", 1, 1'500'000'000, 100.0);
    add("r2", 0, 0, 50.0);
    add("r2", 1, 0, 60.0);
    T_enu_node_.erase(nodes_.back().id);
  }
  void add(const char* agent, std::uint32_t seq, std::int64_t after_ns, double north) {
    graph::Node node;
    node.id = {testing::agent(agent), seq};
    node.stamp = stamp_from_ns(1'795'630'359'000'000'000 + after_ns);
    nodes_.push_back(node);
    T_enu_node_[node.id] = make_pose(Eigen::Matrix3d::Identity(), {0.0, north, 2.0});
  }
  const GeoPoint origin_ = geo_point_from_degrees(48.0, 11.0, 500.0);
  std::vector<graph::Node> nodes_;
  std::map<NodeId, Pose> T_enu_node_;
};

TEST_F(TrackFiles, GpxHasATrackOfEachFrameInUtc) {
  const std::string gpx = to_gpx(nodes_, T_enu_node_, origin_, std::nullopt).value();
  EXPECT_THAT(gpx, HasSubstr("<trk><name>r1</name><trkseg>\n<trkpt lat=\"48.000000000\" lon=\"11.000000000\">"
                             "<ele>502.0000</ele><time>2026-11-25T18:12:39.000Z</time></trkpt>\n"));
  EXPECT_THAT(gpx, HasSubstr("<time>2026-11-25T18:12:40.500Z</time>"));
  EXPECT_THAT(gpx, HasSubstr("<trk><name>r2</name>"));
  EXPECT_THAT(gpx, ::testing::EndsWith("</trk>\n</gpx>\n"));
}

TEST_F(TrackFiles, GpxStatesItsHeightsAndNamesTheNodes) {
  const std::string gpx = to_gpx(nodes_, T_enu_node_, origin_, std::nullopt).value();
  EXPECT_THAT(gpx, HasSubstr("<metadata><desc>Heights: metres above the WGS 84 ellipsoid, not above sea "
                             "level.</desc></metadata>\n<wpt"));
  EXPECT_THAT(gpx, HasSubstr("<wpt lat=\"48.000000000\" lon=\"11.000000000\"><ele>502.0000</ele>"
                             "<time>2026-11-25T18:12:39.000Z</time><name>r1/0</name></wpt>\n"));
  for (const char* node : {"r1/0", "r1/1", "r2/0"})
    EXPECT_THAT(gpx, HasSubstr(std::string("<name>") + node + "</name></wpt>"));
  EXPECT_LT(gpx.rfind("<wpt"), gpx.find("<trk>")) << "the order of GPX's schema";
  EXPECT_THAT(gpx, Not(HasSubstr("geoidheight")));
}

TEST_F(TrackFiles, GpxAboveAGeoidHasItsHeightsToo) {
  const fleetmap::testing::TemporaryFolder folder;
  fleetmap::testing::write_sloped_geoid(folder.path(), "slope");
  setenv("GEOGRAPHICLIB_GEOID_PATH", folder.path().c_str(), 1);
  const auto geoid = Geoid::load("slope");
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
  ASSERT_TRUE(geoid) << geoid.error().message;
  constexpr double kUndulation = 4.8;  // 0.1 m for each degree of latitude
  const std::string gpx = to_gpx(nodes_, T_enu_node_, origin_, *geoid).value();
  EXPECT_THAT(gpx, HasSubstr("Heights: metres above the geoid slope (sea level)."));
  const auto number_of = [&](const std::string& element) {
    return std::stod(gpx.substr(gpx.find('<' + element + '>') + element.size() + 2));
  };
  EXPECT_NEAR(number_of("ele"), 502.0 - kUndulation, 1e-3);
  EXPECT_NEAR(number_of("geoidheight"), kUndulation, 1e-3);
}

TEST_F(TrackFiles, GeoJsonHasLinesAndPointsThatLeadBackToThePoses) {
  const auto collection = nlohmann::json::parse(to_geojson(nodes_, T_enu_node_, origin_));
  EXPECT_EQ(collection["type"], "FeatureCollection");
  ASSERT_EQ(collection["features"].size(), 4u)
      << "three nodes and the track of r1; one node of r2 makes no line";
  const auto& track = collection["features"][2];
  EXPECT_EQ(track["geometry"]["type"], "LineString");
  EXPECT_EQ(track["properties"]["robot"], "r1");
  const auto& end = track["geometry"]["coordinates"][1];
  const Eigen::Vector3d p_enu = LocalFrame(origin_).to_enu(geo_point_from_degrees(end[1], end[0], end[2]));
  EXPECT_LT((p_enu - Eigen::Vector3d(0.0, 100.0, 2.0)).norm(), 5e-4);
  EXPECT_EQ(collection["features"][0]["properties"]["node"], "r1/0");
}

TEST_F(TrackFiles, NothingPlacedIsAnEmptyFile) {
  EXPECT_THAT(to_gpx(nodes_, {}, origin_, std::nullopt).value(), Not(HasSubstr("<trk>")));
  EXPECT_TRUE(nlohmann::json::parse(to_geojson(nodes_, {}, origin_))["features"].empty());
}

TEST_F(TrackFiles, HeightsAboveSeaLevelAreNamedInGpxAndLeftOutOfGeoJson) {
  const std::string gpx = to_gpx(nodes_, T_enu_node_, origin_, std::nullopt, true).value();
  EXPECT_THAT(gpx, HasSubstr("Heights: metres above mean sea level as GPS gave them."));
  const auto collection = nlohmann::json::parse(to_geojson(nodes_, T_enu_node_, origin_, true));
  EXPECT_EQ(collection["features"][0]["geometry"]["coordinates"].size(), 2u);
  EXPECT_EQ(collection["features"][2]["geometry"]["coordinates"][1].size(), 2u);
}

}  // namespace
}  // namespace fleetmap::output
