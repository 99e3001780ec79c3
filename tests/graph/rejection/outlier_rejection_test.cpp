#include "rejection/outlier_rejection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kR1;
using testing::kR2;
using testing::ReducedFleet;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

TEST(OutlierRejection, EveryAlignmentIsAcceptedOrRejected) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFleet fleet(seed, testing::long_mission(4, 150));
    fleet.align_neighbours(6, 0.3);
    const ReducedFleet reduced(fleet);
    const Rejection result =
        reject_outliers(reduced.graph, reduced.candidates, reduced.computed_by, reduced.initial);
    EXPECT_TRUE(result.solvable);
    ASSERT_TRUE(result.solver);
    EXPECT_TRUE(result.quarantined.empty());
    for (std::size_t k = 0; k < fleet.alignments.size(); ++k)
      EXPECT_NE(result.accepted.contains(k), result.rejected.contains(k)) << k;
  }
}

/// The estimate is where the gradient of the accepted factors vanishes: a solver with these makes no step.
TEST(OutlierRejection, TheEstimateIsThatOfTheAcceptedAlignments) {
  SimulatedFleet fleet(2);
  const auto pairs = fleet.near_pairs(kR1, kR2, 4);
  for (const auto& [i, j] : pairs) fleet.align(i, j, kR1, testing::kOneRow);
  const ReducedFleet reduced(fleet);
  const Rejection result =
      reject_outliers(reduced.graph, reduced.candidates, reduced.computed_by, reduced.initial);
  std::vector<const BetweenFactor*> factors;
  std::vector<GraphSolver::Ends> ends;
  for (const auto& [alignment, c] : result.accepted) {
    factors.push_back(&result.candidates[c].factor);
    ends.emplace_back(factors.back()->a, factors.back()->b);
  }
  GraphSolver solver(reduced.graph, ends);
  solver.set_alignments(factors);
  Estimate again = result.estimate;
  ASSERT_EQ(solver.solve(again, kMaxSteps), GraphSolver::Outcome::converged);
  for (std::size_t p = 0; p < again.T_enu.size(); ++p)
    EXPECT_LT((again.T_enu[p].translation() - result.estimate.T_enu[p].translation()).norm(), 1e-3);
}

TEST(OutlierRejection, QuarantinedAgentHasNoCandidates) {
  SimulatedFleetConfig config;
  config.robots = 4;
  config.reach = 40.0;
  SimulatedFleet fleet(1, config);
  const AgentId faulty = SimulatedFleet::agent(3);
  std::erase_if(fleet.alignments,
                [&](const Alignment& a) { return a.i.agent == faulty || a.j.agent == faulty; });
  for (int other = 0; other < 3; ++other) {
    for (const auto& [i, j] : fleet.near_pairs(faulty, SimulatedFleet::agent(other), 2))
      fleet.align(i, j, faulty, Eigen::Vector3d(fleet.gauss(20.0), fleet.gauss(20.0), 0.0));
  }
  const ReducedFleet reduced(fleet);
  const Rejection result =
      reject_outliers(reduced.graph, reduced.candidates, reduced.computed_by, reduced.initial);
  EXPECT_EQ(result.quarantined, std::set{faulty});
  EXPECT_GE(result.outlier_sets.at(faulty), 4u);
  for (const Candidate& candidate : result.candidates)
    EXPECT_NE(reduced.computed_by[candidate.alignment], faulty);
}

TEST(OutlierRejection, WithoutCandidatesItIsThePrior) {
  SimulatedFleet fleet(3);
  fleet.alignments.clear();
  const ReducedFleet reduced(fleet);
  const Rejection result = reject_outliers(reduced.graph, {}, {}, reduced.initial);
  EXPECT_TRUE(result.solvable);
  EXPECT_TRUE(result.solver);
  EXPECT_TRUE(result.accepted.empty());
  EXPECT_TRUE(result.rejected.empty());
}

}  // namespace
}  // namespace fleetmap::graph
