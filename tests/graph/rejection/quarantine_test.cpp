#include "rejection/quarantine.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kR1;
using testing::kR2;
using testing::kR3;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(Quarantine, TakesFourSetsAndTwicePerAcceptedAlignment) {
  const std::map<AgentId, std::size_t> sets{{kR1, 3}, {kR2, 4}, {kR3, 9}};
  EXPECT_EQ(to_quarantine(sets, {}), (std::set{kR2, kR3}));
  EXPECT_EQ(to_quarantine(sets, {{kR2, 2}, {kR3, 4}}), (std::set{kR2, kR3}));
  EXPECT_EQ(to_quarantine(sets, {{kR2, 3}, {kR3, 5}}), std::set<AgentId>());
}

/// Outlier sets if all alignments were rejected.
std::map<AgentId, std::size_t> sets_of(const SimulatedFleet& fleet, AlignmentStatus status) {
  const ReducedFleet reduced(fleet);
  std::map<std::size_t, AlignmentStatus> statuses;
  for (const Candidate& candidate : reduced.candidates) statuses[candidate.alignment] = status;
  return outlier_sets(reduced.graph, reduced.candidates, statuses, reduced.computed_by, reduced.initial);
}

TEST(Quarantine, RejectedAlignmentsThatAgreeAreOneSet) {
  SimulatedFleet fleet(1);
  fleet.alignments.clear();
  const auto pairs = fleet.near_pairs(kR1, kR2, 1);
  for (std::size_t k = 0; k < 4; ++k)
    fleet.align(pairs[k].first, pairs[k].second, kR1, Eigen::Vector3d(30.0, 0.0, 0.0));
  EXPECT_EQ(sets_of(fleet, AlignmentStatus::against_gps).at(kR1), 1u);
  EXPECT_TRUE(sets_of(fleet, AlignmentStatus::undecided).empty());
  fleet.align(pairs[4].first, pairs[4].second, kR1, Eigen::Vector3d(0.0, 30.0, 0.0));
  fleet.align(pairs[5].first, pairs[5].second, kR2, Eigen::Vector3d(30.0, 0.0, 0.0));
  auto sets = sets_of(fleet, AlignmentStatus::against_others);
  EXPECT_EQ(sets.at(kR1), 2u);
  EXPECT_EQ(sets.at(kR2), 1u) << "each by who computed it";
  fleet.align(pairs[6].first, pairs[6].second, kR1, Eigen::Vector3d(0.0, -30.0, 0.0));
  EXPECT_EQ(sets_of(fleet, AlignmentStatus::against_others).at(kR1), 2u) << "at most two with one other";
}

}  // namespace
}  // namespace fleetmap::graph
