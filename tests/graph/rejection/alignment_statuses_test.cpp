#include "rejection/alignment_statuses.hpp"

#include <gtest/gtest.h>

namespace fleetmap::graph {
namespace {

/// Alignments 0 to 4, each with two modes: candidates 2k and 2k + 1.
std::vector<Candidate> candidates() {
  std::vector<Candidate> all(10);
  for (std::size_t c = 0; c < all.size(); ++c) all[c].alignment = c / 2;
  return all;
}

TEST(AlignmentStatuses, AnAlignmentIsRejectedOnlyIfAllOfItsModesAre) {
  PriorEvidence evidence;
  LoopCheck check;
  check.joined.accepted = {{0, 1}};
  evidence.contradicting = {0, 2, 3, 4};  // both modes of 1, one of 2
  evidence.gating.gated_out = {4};        // with the next line both modes of 2
  check.joined.contradicting = {5, 6};    // one mode of 3
  check.exclusions.candidates = {8, 9};   // both modes of 4
  auto statuses = rejected_statuses(candidates(), evidence, check);
  EXPECT_FALSE(statuses.contains(0)) << "accepted";
  EXPECT_EQ(statuses.at(1), AlignmentStatus::against_gps);
  EXPECT_EQ(statuses.at(2), AlignmentStatus::against_others);
  EXPECT_EQ(statuses.at(3), AlignmentStatus::undecided);
  EXPECT_EQ(statuses.at(4), AlignmentStatus::against_others);
  check.exclusions.undecided = {9};
  statuses = rejected_statuses(candidates(), evidence, check);
  EXPECT_EQ(statuses.at(4), AlignmentStatus::undecided);
}

}  // namespace
}  // namespace fleetmap::graph
