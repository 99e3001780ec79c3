#include "problem/initial_estimate.hpp"

#include <gtest/gtest.h>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(InitialEstimate, FramesAreRigidAndLieAtTheirFixes) {
  const SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  const ReducedGraph& graph = reduced.graph;
  ASSERT_EQ(reduced.initial.T_enu.size(), graph.poses.size());
  ASSERT_EQ(reduced.initial.drift.size(), graph.poses.size());
  for (const BetweenFactor& step : graph.odometry) {
    const Pose T_a_b = reduced.initial.T_enu[step.a].inverse() * reduced.initial.T_enu[step.b];
    EXPECT_LT(se3_log(T_a_b.inverse() * step.T_a_b).norm(), 1e-9);
  }
  for (std::size_t p = 0; p < graph.poses.size(); ++p) {
    const Pose& truth = fleet.truth.at(graph.nodes[graph.poses[p].node]->id);
    EXPECT_LT((reduced.initial.T_enu[p].translation() - truth.translation()).norm(), 10.0);
  }
}

}  // namespace
}  // namespace fleetmap::graph
