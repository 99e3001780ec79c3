#include "fleetmap/monitor/fleet_drawing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "monitor/views.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;
using testing::node_id;
using testing::ViewMaker;

TEST(FleetDrawing, the_newest_placed_node_counts) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0, 3).robot("r2", 50.0, 2, false);
  for (std::size_t k = 0; k < 3; ++k) fleet.view.nodes[k].stamp = stamp_from_ns(10 - static_cast<int>(k));
  fleet.view.placement.T_enu_node.erase(node_id("r1", 0));
  const auto last = last_nodes(fleet.view);
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last.at(node_id("r1", 0).agent).id, node_id("r1", 1)) << "r1/0 is newer, but has no place";
  EXPECT_TRUE(last.at(node_id("r1", 0).agent).georeferenced);
  EXPECT_FALSE(last.at(node_id("r2", 0).agent).georeferenced) << "without GPS";
}

TEST(FleetDrawing, alignments_join_their_nodes_under_their_status) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0).robot("r2", 50.0);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::used);
  fleet.alignment(node_id("r1", 1), node_id("r2", 1), AlignmentStatus::against_gps);
  fleet.alignment(node_id("r1", 2), node_id("r2", 9), AlignmentStatus::used);  // of a node that has no place
  const auto lines = alignment_lines(fleet.view);
  const auto of = [&](AlignmentStatus status) {
    return std::ranges::find(lines, status, &AlignmentLines::status)->points;
  };
  EXPECT_EQ(of(AlignmentStatus::used), (std::vector<Eigen::Vector3d>{{0.0, 0.0, 0.0}, {50.0, 0.0, 0.0}}));
  EXPECT_EQ(of(AlignmentStatus::against_gps),
            (std::vector<Eigen::Vector3d>{{4.0, 0.0, 0.0}, {54.0, 0.0, 0.0}}));
  EXPECT_TRUE(of(AlignmentStatus::quarantined).empty());
}

}  // namespace
}  // namespace fleetmap::monitor
