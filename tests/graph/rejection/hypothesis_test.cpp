#include "rejection/hypothesis.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kR1;
using testing::kR2;
using testing::kR3;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(Hypothesis, SupportGrowsWithMembersButLessWithEach) {
  EXPECT_EQ(support_of(0.0), 0.0);
  for (int k = 1; k < 40; ++k) {
    const double n = k;
    EXPECT_GT(support_of(n), support_of(n - 1.0));
    EXPECT_LT(support_of(n + 1.0) - support_of(n), support_of(n) - support_of(n - 1.0));
  }
}

TEST(Hypothesis, DistanceToThePriorIsAQuadraticFormOfTheResiduals) {
  const SimulatedFleet fleet(4);
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  auto candidates = linearise(reduced.candidates, reduced.between(kR1, kR2), prior.solved());
  const CrossCovariances cross = cross_covariances(candidates);
  const std::vector<Indices> hypotheses{{0, 1, 2, 3}};
  const double distance = squared_distance_to_prior(hypotheses, candidates, cross);
  EXPECT_GT(distance, 0.0);
  for (LinearisedCandidate& one : candidates) one.e *= 3.0;
  EXPECT_NEAR(squared_distance_to_prior(hypotheses, candidates, cross), 9.0 * distance, 1e-6 * distance);
  for (LinearisedCandidate& one : candidates) one.e.setZero();
  EXPECT_NEAR(squared_distance_to_prior(hypotheses, candidates, cross), 0.0, 1e-9);
}

TEST(Hypothesis, DistanceIsThatOfTheTranslationThatAllMembersAskFor) {
  const SimulatedFleet fleet(5);
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  auto candidates = linearise(reduced.candidates, reduced.between(kR1, kR2), prior.solved());
  const CrossCovariances cross = cross_covariances(candidates);
  double before = 0.0;
  for (const double metres : {2.0, 4.0, 8.0}) {
    for (LinearisedCandidate& one : candidates) one.e = one.B * Eigen::Vector3d(metres, 0.0, 0.0);
    const double distance = squared_distance_to_prior({{0, 1, 2}}, candidates, cross);
    // GPS of 1.5 m: 2 m are usual, 8 m are not.
    if (before > 0.0) {
      EXPECT_NEAR(distance, 4.0 * before, 1e-6 * distance);
    }
    before = distance;
  }
  EXPECT_GT(before, 10.0);
}

TEST(Hypothesis, DistanceOfTwoPairsIsAtLeastThatOfEach) {
  const SimulatedFleet fleet(6);
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  Indices all = reduced.between(kR1, kR2);
  const std::size_t first = all.size();
  for (const std::size_t c : reduced.between(kR2, kR3)) all.push_back(c);
  ASSERT_GE(first, 2u);
  ASSERT_GE(all.size(), first + 2);
  const auto candidates = linearise(reduced.candidates, all, prior.solved());
  const CrossCovariances cross = cross_covariances(candidates);
  const Indices a{0, 1}, b{first, first + 1};
  const double both = squared_distance_to_prior({a, b}, candidates, cross);
  EXPECT_GE(both, squared_distance_to_prior({a}, candidates, cross) - 1e-9);
  EXPECT_GE(both, squared_distance_to_prior({b}, candidates, cross) - 1e-9);
}

}  // namespace
}  // namespace fleetmap::graph
