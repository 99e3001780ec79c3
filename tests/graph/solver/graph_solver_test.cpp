#include "solver/graph_solver.hpp"

#include <gtest/gtest.h>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::ReducedFleet;
using testing::SimulatedFleet;

/// Solved with all alignments of a fleet.
struct Solved {
  explicit Solved(const ReducedFleet& fleet, std::span<const GraphSolver::Ends> ends)
      : solver(fleet.graph, ends), estimate(fleet.initial) {
    std::vector<const BetweenFactor*> factors;
    for (const Candidate& candidate : fleet.candidates) factors.push_back(&candidate.factor);
    solver.set_alignments(factors);
    outcome = solver.solve(estimate, kMaxSteps);
  }
  GraphSolver solver;
  Estimate estimate;
  GraphSolver::Outcome outcome = GraphSolver::Outcome::failed;
};

std::vector<GraphSolver::Ends> ends_of(const ReducedFleet& fleet) {
  std::vector<GraphSolver::Ends> ends;
  for (const Candidate& candidate : fleet.candidates)
    ends.emplace_back(candidate.factor.a, candidate.factor.b);
  return ends;
}

TEST(GraphSolver, TheSolutionDoesNotDependOnTheStart) {
  const SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  const auto ends = ends_of(reduced);
  Solved one(reduced, ends);
  ASSERT_EQ(one.outcome, GraphSolver::Outcome::converged);
  Estimate other = reduced.initial;
  for (Pose& T : other.T_enu) T.pretranslate(Eigen::Vector3d(20.0, -10.0, 1.0));
  std::vector<const BetweenFactor*> factors;
  for (const Candidate& candidate : reduced.candidates) factors.push_back(&candidate.factor);
  one.solver.set_alignments(factors);
  ASSERT_EQ(one.solver.solve(other, kMaxSteps), GraphSolver::Outcome::converged);
  for (std::size_t p = 0; p < other.T_enu.size(); ++p)
    EXPECT_LT(se3_log(other.T_enu[p].inverse() * one.estimate.T_enu[p]).norm(), 2e-3);
}

TEST(GraphSolver, RelativeCovariancesAreInnerProductsOfSensitivities) {
  const SimulatedFleet fleet(2);
  const ReducedFleet reduced(fleet);
  const auto ends = ends_of(reduced);
  Solved solved(reduced, ends);
  std::vector<int> poses;
  for (const auto& [a, b] : ends) poses.insert(poses.end(), {static_cast<int>(a), static_cast<int>(b)});
  solved.solver.invert(poses);
  for (const auto& [a, b] : ends) {
    const Matrix6d H_a = relative_residual(solved.estimate, a, b, Pose::Identity()).H_a;
    const auto z = solved.solver.sensitivity(a, b, H_a, Matrix6d::Identity());
    const Matrix6d expected = BlockCholesky::inner(z, z);
    EXPECT_LT((solved.solver.relative_covariance(a, b, H_a) - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(GraphSolver, AlignmentsMakeRelativePosesMoreCertain) {
  const SimulatedFleet fleet(3);
  const ReducedFleet reduced(fleet);
  Estimate prior = reduced.initial;
  GraphSolver alone(reduced.graph, {});
  ASSERT_EQ(alone.solve(prior, kMaxSteps), GraphSolver::Outcome::converged);
  Solved solved(reduced, ends_of(reduced));
  for (const Candidate& candidate : reduced.candidates) {
    const auto [a, b] = std::pair(candidate.factor.a, candidate.factor.b);
    const Matrix6d H_a = -adjoint(candidate.factor.T_a_b.inverse());
    const auto before = alone.sensitivity(a, b, H_a, Matrix6d::Identity());
    const auto after = solved.solver.sensitivity(a, b, H_a, Matrix6d::Identity());
    EXPECT_LT(BlockCholesky::inner(after, after).trace(), 0.1 * BlockCholesky::inner(before, before).trace());
  }
}

}  // namespace
}  // namespace fleetmap::graph
