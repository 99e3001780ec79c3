#include "rejection/prior_evidence.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::evidence_of;
using testing::kR1;
using testing::kR2;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(PriorEvidence, TrueAlignmentsOfAPairAreOneHypothesis) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const SimulatedFleet fleet(seed);
    const ReducedFleet reduced(fleet);
    const PriorSolution prior(reduced);
    const PriorEvidence evidence = evidence_of(reduced, prior);
    EXPECT_TRUE(evidence.contradicting.empty()) << seed;
    for (const auto& [frames, sets] : evidence.sets) {
      ASSERT_FALSE(sets.hypotheses.empty()) << seed;
      EXPECT_GE(sets.hypotheses.front().members.size() + 1, evidence.gating.groups.at(frames).size()) << seed;
    }
  }
}

/// Each alone is within the gate of GPS, but not all of them by the same translation.
TEST(PriorEvidence, AHypothesisThatThePriorContradictsIsRejectedAsAWhole) {
  SimulatedFleet fleet(2);
  fleet.alignments.clear();
  const auto pairs = fleet.near_pairs(kR1, kR2, 1);
  for (std::size_t k = 0; k < pairs.size(); k += 2)
    fleet.align(pairs[k].first, pairs[k].second, kR1, Eigen::Vector3d(11.0, 0.0, 0.0));
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const PriorEvidence evidence = evidence_of(reduced, prior);
  EXPECT_EQ(evidence.contradicting.size(), reduced.candidates.size());
  for (const std::size_t c : evidence.contradicting_together) EXPECT_TRUE(evidence.contradicting.contains(c));
}

TEST(PriorEvidence, AgreementOfAmbiguousLoopsIsNoEvidence) {
  SimulatedFleet fleet(3);
  fleet.alignments.clear();
  for (std::uint32_t k = 5; k < 12; ++k) {
    Alignment& a = fleet.align({kR1, k}, {kR1, 35 - k}, kR1);
    a.modes.push_back(a.modes.front());
  }
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const PriorEvidence evidence = evidence_of(reduced, prior);
  ASSERT_EQ(evidence.sets.size(), 1u);
  EXPECT_TRUE(evidence.sets.begin()->second.hypotheses.empty());
}

}  // namespace
}  // namespace fleetmap::graph
