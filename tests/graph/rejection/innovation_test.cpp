#include "rejection/innovation.hpp"

#include <gtest/gtest.h>

#include <array>

#include "graph/simulated_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::SimulatedFleet;

TEST(Innovation, WithoutAFactorIsThatOfAGraphWithoutIt) {
  SimulatedFleet fleet(4);
  const Eigen::Vector3d off(0.4, 0.0, 0.0);  // far beyond where the Huber weight begins
  const Alignment base = fleet.alignments.front();
  fleet.align(base.i, base.j, base.computed_by, off);
  std::vector<const Node*> nodes;
  for (const Node& node : fleet.nodes) nodes.push_back(&node);
  std::vector<NodeId> ends;
  for (const Alignment& a : fleet.alignments) ends.insert(ends.end(), {a.i, a.j});
  const ReducedGraph graph = reduce(nodes, ends, fleet.site, {});
  std::vector<BetweenFactor> factors;
  std::vector<GraphSolver::Ends> pairs;
  for (const Alignment& a : fleet.alignments) {
    factors.emplace_back(graph.pose_of.at(a.i), graph.pose_of.at(a.j), a.best().T_i_j, a.best().covariance);
    pairs.emplace_back(factors.back().a, factors.back().b);
  }
  Estimate with;
  with.drift.assign(graph.poses.size(), Eigen::Vector3d::Zero());
  for (const PoseVariable& variable : graph.poses)
    with.T_enu.push_back(fleet.truth.at(graph.nodes[variable.node]->id));
  Estimate without = with;
  std::vector<const BetweenFactor*> all;
  for (const BetweenFactor& factor : factors) all.push_back(&factor);
  const std::array ends_of_last{static_cast<int>(factors.back().a), static_cast<int>(factors.back().b)};
  GraphSolver solver(graph, pairs);
  solver.set_alignments(all);
  ASSERT_EQ(solver.solve(with, 100), GraphSolver::Outcome::converged);
  solver.invert(ends_of_last);
  const Innovation rest = innovation_without(factors.back(), {solver, with});
  all.pop_back();
  solver.set_alignments(all);
  ASSERT_EQ(solver.solve(without, 100), GraphSolver::Outcome::converged);
  solver.invert(ends_of_last);
  const Innovation expected = innovation(factors.back(), {solver, without});
  EXPECT_NEAR(rest.distance, expected.distance, 0.15 * expected.distance);
  EXPECT_NEAR(rest.sigma_m, expected.sigma_m, 0.05 * expected.sigma_m);
}

}  // namespace
}  // namespace fleetmap::graph
