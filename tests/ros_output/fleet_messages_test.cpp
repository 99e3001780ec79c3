#include "fleetmap/ros_output/fleet_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "monitor/views.hpp"

namespace fleetmap::ros_output {
namespace {

using graph::AlignmentStatus;
using ros_codec::Marker;
using testing::node_id;
using testing::ViewMaker;

ViewMaker two_robots() {
  ViewMaker fleet;
  fleet.robot("r1", 0.0).robot("r2", 50.0);
  fleet.view.self = node_id("r1", 0).agent;
  return fleet;
}

std::vector<Marker> group(const ros_codec::MarkersMsg& message, const std::string& name) {
  std::vector<Marker> found;
  std::ranges::copy_if(message.markers, std::back_inserter(found),
                       [&](const Marker& marker) { return marker.group == name; });
  return found;
}

TEST(FleetMessages, ThePathIsTheOwnNodesInTheOrderOfTime) {
  ViewMaker fleet = two_robots();
  for (std::size_t k = 0; k < 3; ++k)
    fleet.view.nodes[k].stamp = stamp_from_ns(100 - static_cast<std::int64_t>(k));
  fleet.view.placement.T_enu_node.erase(node_id("r1", 1));
  const ros_codec::PathMsg path = path_message(fleet.view);
  EXPECT_EQ(path.frame, "map");
  ASSERT_EQ(path.poses.size(), 2u) << "one of three has no pose";
  EXPECT_EQ(path.poses[0].stamp, stamp_from_ns(98));
  EXPECT_EQ(path.poses[0].T_frame_base.translation(), Eigen::Vector3d(8.0, 0.0, 0.0));
  EXPECT_EQ(path.poses[1].T_frame_base.translation(), Eigen::Vector3d(0.0, 0.0, 0.0));
}

TEST(FleetMessages, MarkersShowTracksAlignmentsByVerdictAndTheOtherRobots) {
  ViewMaker fleet = two_robots();
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::used);
  fleet.alignment(node_id("r1", 1), node_id("r2", 1), AlignmentStatus::used);
  fleet.alignment(node_id("r1", 2), node_id("r2", 2), AlignmentStatus::quarantined);
  const ros_codec::MarkersMsg message = markers_message(fleet.view);
  EXPECT_EQ(message.frame, "map");
  ASSERT_EQ(group(message, "tracks").size(), 2u);
  EXPECT_NE(group(message, "tracks")[0].rgb, group(message, "tracks")[1].rgb);
  EXPECT_EQ(group(message, "nodes")[1].points.back(), Eigen::Vector3d(58.0, 0.0, 0.0));
  const auto used = group(message, "alignments/used"), refused = group(message, "alignments/quarantined");
  ASSERT_EQ(used.size(), 1u);
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(used[0].points.size(), 4u);
  EXPECT_EQ(refused[0].points.size(), 2u);
  EXPECT_NE(used[0].rgb, refused[0].rgb);
  const auto robots = group(message, "robots");
  ASSERT_EQ(robots.size(), 2u) << "r2 and its name, not r1";
  EXPECT_EQ(robots[0].T_frame_marker.translation(), Eigen::Vector3d(58.0, 0.0, 0.0));
  EXPECT_EQ(robots[1].text, "r2");
}

/// RViz replaces a marker by another of the same group and id, and refuses a line of one point.
TEST(FleetMessages, NoTwoMarkersHaveOneNameAndNoLineHasOnePoint) {
  ViewMaker fleet = two_robots();
  fleet.robot("r3", 90.0, 1).robot("r4", 95.0, 2);
  std::set<std::pair<std::string, int>> names;
  for (const Marker& marker : markers_message(fleet.view).markers) {
    EXPECT_TRUE(names.emplace(marker.group, marker.id).second) << marker.group << " " << marker.id;
    if (marker.type == Marker::Type::line_strip) {
      EXPECT_GT(marker.points.size(), 1u);
    }
  }
  EXPECT_EQ(names.count({"nodes", 3}), 1u);
}

TEST(FleetMessages, AViewIsWhatWasPlaced) {
  graph::PlacedFleet fleet;
  fleet.nodes = two_robots().view.nodes;
  fleet.placement = two_robots().view.placement;
  const monitor::FleetView view = view_of(fleet, node_id("r2", 0).agent);
  EXPECT_EQ(path_message(view).poses.size(), 3u);
  EXPECT_EQ(path_message(view).poses[0].T_frame_base.translation().x(), 50.0);
}

}  // namespace
}  // namespace fleetmap::ros_output
