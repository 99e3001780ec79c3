#include "rejection/pairwise_consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kOneRow;
using testing::kR1;
using testing::kR2;
using testing::names_from;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

/// True alignments of r1 and r2, and some one row off.
SimulatedFleet with_a_false_row(unsigned seed, std::size_t count) {
  SimulatedFleet fleet(seed);
  const auto pairs = fleet.near_pairs(kR1, kR2, 1);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [i, j] = pairs[k * pairs.size() / count];
    fleet.align(i, j, kR1, kOneRow);
  }
  return fleet;
}

bool is_one_of(const ReducedFleet& fleet, std::size_t candidate,
               const std::set<testing::AlignmentName>& names) {
  const Alignment& a = *fleet.items.alignments[fleet.candidates[candidate].alignment];
  return names.contains({a.computed_by, a.seq});
}

TEST(PairwiseConsistency, SeparatesTwoRowsAndPrefersTheTrueOne) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const SimulatedFleet fleet = with_a_false_row(seed, 5);
    const auto false_ones = names_from(fleet, SimulatedFleet(seed).alignments.size());
    const ReducedFleet reduced(fleet);
    const PriorSolution prior(reduced);
    const Indices group = reduced.between(kR1, kR2);
    const ConsistentSets sets = consistent_sets(reduced.candidates, group, prior.solved());
    std::vector<Hypothesis> all = sets.hypotheses;
    all.insert(all.end(), sets.rejected.begin(), sets.rejected.end());
    for (const Hypothesis& hypothesis : all) {
      const bool first = is_one_of(reduced, hypothesis.members.front(), false_ones);
      for (const std::size_t c : hypothesis.members)
        EXPECT_EQ(is_one_of(reduced, c, false_ones), first) << "seed " << seed << ": a set of both rows";
    }
    ASSERT_FALSE(sets.hypotheses.empty()) << seed;
    EXPECT_FALSE(is_one_of(reduced, sets.hypotheses.front().members.front(), false_ones)) << seed;
  }
}

TEST(PairwiseConsistency, TheSetsAreAPartitionWithOneModeOfAnAlignmentEach) {
  SimulatedFleet fleet(7);
  for (Alignment& a : fleet.alignments) {
    Pose T = fleet.truth.at(a.j);
    T.pretranslate(kOneRow);
    a.modes.push_back(fleet.observed_at(a.i, T));
    a.modes.push_back(fleet.observed_at(a.i, fleet.truth.at(a.j)));  // nearly the first one
  }
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  Indices group = reduced.between(kR1, kR2);
  group.resize(std::min<std::size_t>(group.size(), 16));  // all of them are linearised
  const ConsistentSets sets = consistent_sets(reduced.candidates, group, prior.solved());
  Indices members;
  for (const auto* some : {&sets.hypotheses, &sets.rejected}) {
    for (const Hypothesis& hypothesis : *some) {
      std::set<std::size_t> alignments;
      for (const std::size_t c : hypothesis.members) alignments.insert(reduced.candidates[c].alignment);
      EXPECT_EQ(alignments.size(), hypothesis.members.size());
      members.insert(members.end(), hypothesis.members.begin(), hypothesis.members.end());
    }
  }
  std::ranges::sort(members);
  EXPECT_EQ(members, group);
}

TEST(PairwiseConsistency, CandidatesThatWereNotLinearisedFollowTheirSet) {
  const SimulatedFleet fleet = with_a_false_row(3, 20);
  const auto false_ones = names_from(fleet, SimulatedFleet(3).alignments.size());
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const Indices group = reduced.between(kR1, kR2);
  ASSERT_GT(group.size(), 20u);
  const ConsistentSets sets = consistent_sets(reduced.candidates, group, prior.solved());
  std::vector<Hypothesis> all = sets.hypotheses;
  all.insert(all.end(), sets.rejected.begin(), sets.rejected.end());
  std::size_t assigned = 0;
  for (const Indices& members : extended_members(reduced.candidates, all, group, prior.solved())) {
    assigned += members.size();
    for (const std::size_t c : members)
      EXPECT_EQ(is_one_of(reduced, c, false_ones), is_one_of(reduced, members.front(), false_ones));
  }
  EXPECT_GE(assigned + 1, group.size());
}

TEST(PairwiseConsistency, OnlyAClearBestIsTaken) {
  ConsistentSets sets;
  EXPECT_FALSE(clear_best(sets, {}));
  const auto of = [](const Indices& members, double evidence) {
    Hypothesis hypothesis;
    hypothesis.members = members;
    hypothesis.evidence = evidence;
    return hypothesis;
  };
  sets.hypotheses.push_back(of({1, 2}, 10.0));
  EXPECT_TRUE(clear_best(sets, {}));
  EXPECT_FALSE(clear_best(sets, {2})) << "excluded";
  sets.hypotheses.push_back(of({3}, 10.0 - 0.9 * kMargin));
  EXPECT_FALSE(clear_best(sets, {})) << "two alike";
  EXPECT_EQ(clear_best(sets, {1})->members, Indices{3});
  sets.hypotheses = {of({1}, -1.0)};
  EXPECT_FALSE(clear_best(sets, {})) << "less likely than not";
}

}  // namespace
}  // namespace fleetmap::graph
