#include "rejection/frame_joining.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::evidence_of;
using testing::kOneRow;
using testing::kR1;
using testing::kR2;
using testing::names_from;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

JoinedFrames join(const ReducedFleet& fleet, const TrialExclusions& exclusions = {}) {
  const PriorSolution prior(fleet);
  const PriorEvidence evidence = evidence_of(fleet, prior);
  std::vector<GraphSolver::Ends> pairs;
  for (const Candidate& candidate : fleet.candidates)
    pairs.emplace_back(candidate.factor.a, candidate.factor.b);
  GraphSolver solver(fleet.graph, pairs);
  return join_frames(fleet.problem(), evidence, exclusions, prior.solved().estimate, solver);
}

TEST(FrameJoining, AcceptsTrueAlignmentsAndNoneOfAFalseRow) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFleet fleet(seed);
    const std::size_t right = fleet.alignments.size();
    const auto pairs = fleet.near_pairs(kR1, kR2, 5);
    for (const auto& [i, j] : pairs) fleet.align(i, j, kR2, kOneRow);
    const auto false_ones = names_from(fleet, right);
    const ReducedFleet reduced(fleet);
    const JoinedFrames joined = join(reduced);
    EXPECT_TRUE(joined.solved);
    EXPECT_GE(joined.accepted.size() * 100, right * 97);
    for (const auto& [alignment, candidate] : joined.accepted) {
      const Alignment& a = *reduced.items.alignments[alignment];
      EXPECT_FALSE(false_ones.contains({a.computed_by, a.seq})) << seed;
      EXPECT_EQ(reduced.candidates[candidate].alignment, alignment);
      EXPECT_FALSE(joined.contradicting.contains(candidate));
    }
  }
}

TEST(FrameJoining, ExcludedFramesAndCandidatesAreNotJoined) {
  const SimulatedFleet fleet(2);
  const ReducedFleet reduced(fleet);
  const Indices pair = reduced.between(kR1, kR2);
  TrialExclusions exclusions;
  exclusions.frames.insert(reduced.candidates[pair.front()].frames);
  for (const auto& [alignment, c] : join(reduced, exclusions).accepted)
    EXPECT_NE(reduced.candidates[c].frames, reduced.candidates[pair.front()].frames);
  exclusions = {};
  exclusions.candidates.insert(pair.begin(), pair.end());
  for (const auto& [alignment, c] : join(reduced, exclusions).accepted)
    EXPECT_FALSE(exclusions.candidates.contains(c));
}

TEST(FrameJoining, FactorsAndEndsAreThoseOfTheCandidates) {
  const SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  const auto factors = factors_of(reduced.candidates, {{4, 4}, {1, 1}});
  ASSERT_EQ(factors.size(), 2u);
  EXPECT_EQ(factors[0], &reduced.candidates[1].factor);
  EXPECT_EQ(factors[1], &reduced.candidates[4].factor);
  EXPECT_EQ(ends_of(reduced.candidates).size(), 2 * reduced.candidates.size());
}

}  // namespace
}  // namespace fleetmap::graph
