#include "fleetmap/output/track_files.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numbers>

namespace fleetmap::output {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

AgentId id(const char* name) { return *AgentId::parse(name); }

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
    node.id = {id(agent), seq};
    node.stamp = stamp_from_ns(1'795'630'359'000'000'000 + after_ns);
    nodes_.push_back(node);
    T_enu_node_[node.id] = make_pose(Eigen::Matrix3d::Identity(), {0.0, north, 2.0});
  }
  const GeoPoint origin_ = geo_point_from_degrees(48.0, 11.0, 500.0);
  std::vector<graph::Node> nodes_;
  std::map<NodeId, Pose> T_enu_node_;
};

TEST_F(TrackFiles, GpxHasATrackOfEachFrameInUtc) {
  const std::string gpx = to_gpx(nodes_, T_enu_node_, origin_);
  EXPECT_THAT(gpx, HasSubstr("<trk><name>r1</name><trkseg>\n<trkpt lat=\"48.000000000\" lon=\"11.000000000\">"
                             "<ele>502.0000</ele><time>2026-11-25T18:12:39.000Z</time></trkpt>\n"));
  EXPECT_THAT(gpx, HasSubstr("<time>2026-11-25T18:12:40.500Z</time>"));
  EXPECT_THAT(gpx, HasSubstr("<trk><name>r2</name>"));
  EXPECT_THAT(gpx, ::testing::EndsWith("</trk>\n</gpx>\n"));
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
  EXPECT_THAT(to_gpx(nodes_, {}, origin_), Not(HasSubstr("<trk>")));
  EXPECT_TRUE(nlohmann::json::parse(to_geojson(nodes_, {}, origin_))["features"].empty());
}

}  // namespace
}  // namespace fleetmap::output
