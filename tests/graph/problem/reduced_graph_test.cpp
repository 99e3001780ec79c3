#include "problem/reduced_graph.hpp"

#include <gtest/gtest.h>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(ReducedGraph, PoseVariablesAreEndsOfFramesAlignmentsAndWindows) {
  const SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  const ReducedGraph& graph = reduced.graph;
  ASSERT_EQ(graph.frames.size(), 3u);
  EXPECT_EQ(graph.odometry.size() + graph.frames.size(), graph.poses.size());
  EXPECT_LT(graph.poses.size(), graph.nodes.size());
  for (const FrameSpan& frame : graph.frames) {
    EXPECT_EQ(graph.poses[frame.first_pose].node, frame.first);
    EXPECT_TRUE(graph.poses[frame.first_pose].has_window);
    EXPECT_EQ(graph.poses[frame.end_pose - 1].node, frame.end - 1);
  }
  for (const Alignment& a : fleet.alignments) {
    EXPECT_EQ(graph.nodes[graph.poses[graph.pose_of.at(a.i)].node]->id, a.i);
    EXPECT_EQ(graph.nodes[graph.poses[graph.pose_of.at(a.j)].node]->id, a.j);
  }
}

TEST(ReducedGraph, OdometryFactorsComposeToTheOdometryOfTheFrame) {
  const SimulatedFleet fleet(2);
  const ReducedFleet reduced(fleet);
  const ReducedGraph& graph = reduced.graph;
  for (const BetweenFactor& step : graph.odometry) {
    const Node &a = *graph.nodes[graph.poses[step.a].node], &b = *graph.nodes[graph.poses[step.b].node];
    EXPECT_EQ(step.b, step.a + 1);
    EXPECT_LT(se3_log((a.T_odom_base * step.T_a_b).inverse() * b.T_odom_base).norm(), 1e-9);
    EXPECT_LT((step.covariance * step.information - Matrix6d::Identity()).norm(), 1e-6);
    // Rotations add up whatever the way between; a floor a step comes to them.
    double sum = 0.0;
    for (std::size_t k = graph.poses[step.a].node + 1; k <= graph.poses[step.b].node; ++k)
      sum += graph.nodes[k]->odom_covariance.bottomRightCorner<3, 3>().trace();
    const double turn = step.covariance.bottomRightCorner<3, 3>().trace();
    EXPECT_GE(turn, sum);
    EXPECT_LT(turn, 1.5 * sum);
  }
}

TEST(ReducedGraph, DriftOfGpsLinksTheWindowsOfARobotAcrossItsSessions) {
  SimulatedFleet fleet(3);
  fleet.kidnap(SimulatedFleet::agent(0), 30);
  const ReducedFleet reduced(fleet);
  std::size_t windows = 0, across = 0;
  for (const PoseVariable& pose : reduced.graph.poses) windows += pose.has_window;
  EXPECT_EQ(reduced.graph.drift.size(), windows - 3) << "one chain a robot";
  for (const DriftFactor& link : reduced.graph.drift) {
    across += reduced.graph.poses[link.a].frame != reduced.graph.poses[link.b].frame;
    EXPECT_GT(link.decay.minCoeff(), 0.0);
    EXPECT_LT(link.decay.maxCoeff(), 1.0);
  }
  EXPECT_EQ(across, 1u);
}

}  // namespace
}  // namespace fleetmap::graph
