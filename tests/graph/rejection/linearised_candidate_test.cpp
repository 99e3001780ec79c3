#include "rejection/linearised_candidate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numeric>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(LinearisedCandidate, DistancesFollowTheChainRule) {
  const SimulatedFleet fleet(2);
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const auto candidates = linearise(reduced.candidates, Indices{0, 1, 4, 9}, prior.solved());
  const CrossCovariances cross = cross_covariances(candidates);
  for (std::size_t b = 0; b < candidates.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      Eigen::Matrix<double, 12, 12> joint;
      joint << candidates[a].S, cross[b][a].transpose(), cross[b][a], candidates[b].S;
      Eigen::Matrix<double, 12, 1> e;
      e << candidates[a].e, candidates[b].e;
      const double alone = candidates[a].e.dot(candidates[a].S.ldlt().solve(candidates[a].e));
      const double both = e.dot(joint.ldlt().solve(e));
      EXPECT_NEAR(conditional_residual(candidates[a], candidates[b], cross[b][a]).distance, both - alone,
                  1e-6 * both);
    }
  }
}

TEST(LinearisedCandidate, BIsTheDerivativeByATranslationOfTheSecondFrame) {
  const SimulatedFleet fleet(3);
  const ReducedFleet reduced(fleet);
  Estimate estimate = reduced.initial;
  GraphSolver solver(reduced.graph, {});
  ASSERT_EQ(solver.solve(estimate, kMaxSteps), GraphSolver::Outcome::converged);
  for (const std::size_t c : {0u, 5u, 11u}) {
    const LinearisedCandidate before = linearise(reduced.candidates, c, {solver, estimate});
    const Eigen::Vector3d step(1e-4, -2e-4, 3e-4);
    Estimate moved = estimate;
    const FrameSpan& second = reduced.graph.frames[reduced.candidates[c].frames.second];
    for (std::size_t p = second.first_pose; p < second.end_pose; ++p) moved.T_enu[p].pretranslate(step);
    const LinearisedCandidate after = linearise(reduced.candidates, c, {solver, moved});
    EXPECT_LT((after.e - before.e - before.B * step).norm(), 0.1 * step.norm()) << c;
  }
}

TEST(LinearisedCandidate, EvenlySpacedOnesAreSomeInTheirOrder) {
  Indices all(37);
  std::iota(all.begin(), all.end(), 100u);
  EXPECT_EQ(evenly_spaced(all, 50), all);
  EXPECT_TRUE(evenly_spaced({}, 3).empty());
  const Indices some = evenly_spaced(all, 5);
  ASSERT_EQ(some.size(), 5u);
  for (std::size_t k = 1; k < some.size(); ++k) {
    EXPECT_GE(some[k] - some[k - 1], 7u);
    EXPECT_LE(some[k] - some[k - 1], 8u);
  }
}

}  // namespace
}  // namespace fleetmap::graph
