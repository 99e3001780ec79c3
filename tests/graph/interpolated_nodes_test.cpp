#include "interpolated_nodes.hpp"

#include <gtest/gtest.h>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::ReducedFleet;
using testing::SimulatedFleet;

/// The same as if every node were a pose variable.
TEST(InterpolatedNodes, PosesAndCovariancesAreThoseOfTheWholeGraph) {
  SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  Estimate estimate = reduced.initial;
  GraphSolver solver(reduced.graph, {});
  ASSERT_EQ(solver.solve(estimate, kMaxSteps), GraphSolver::Outcome::converged);
  std::vector<NodeId> all;
  for (const Node& node : fleet.nodes) all.push_back(node.id);
  const ReducedGraph whole = reduce(reduced.items.nodes, all, fleet.site, {});
  ASSERT_EQ(whole.poses.size(), fleet.nodes.size());
  Estimate of_whole;
  of_whole.T_enu = interpolated_poses(reduced.graph, reduced.initial);
  of_whole.drift.assign(whole.poses.size(), Eigen::Vector3d::Zero());
  GraphSolver whole_solver(whole, {});
  ASSERT_EQ(whole_solver.solve(of_whole, kMaxSteps), GraphSolver::Outcome::converged);
  const std::vector<Pose> T_enu = interpolated_poses(reduced.graph, estimate);
  for (std::size_t k = 0; k < T_enu.size(); ++k) {
    EXPECT_LT((T_enu[k].translation() - of_whole.T_enu[k].translation()).norm(), 5e-3) << k;
    const Matrix6d C = covariance_of_node(reduced.graph, solver, k);
    const Matrix6d expected = covariance_of_node(whole, whole_solver, k);
    EXPECT_LT((C - expected).norm(), 0.02 * expected.norm()) << k;
  }
}

}  // namespace
}  // namespace fleetmap::graph
