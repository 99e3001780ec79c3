#include "rejection/prior_gating.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kR1;
using testing::kR2;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(PriorGating, TrueOnesAreCompatibleAndDistantOnesAreGatedOut) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SimulatedFleet fleet(seed);
    const auto [i, j] = fleet.near_pairs(kR1, kR2, 1).front();
    const Alignment far = fleet.align(i, j, kR1, Eigen::Vector3d(100.0, 0.0, 0.0));
    const ReducedFleet reduced(fleet);
    const PriorSolution prior(reduced);
    const PriorGating gating = gate_by_prior(reduced.candidates, prior.solved());
    ASSERT_EQ(gating.gated_out.size(), 1u) << seed;
    const std::size_t out = *gating.gated_out.begin();
    EXPECT_EQ(reduced.items.alignments[reduced.candidates[out].alignment]->seq, far.seq);
    EXPECT_EQ(gating.contradicting, gating.gated_out) << seed;
  }
}

TEST(PriorGating, EveryCandidateIsInItsGroupOrGatedOut) {
  SimulatedFleet fleet(3);
  for (int k = 0; k < 13; ++k) {
    const double metres = 2.0 * std::pow(1.3, k);
    const auto [i, j] = fleet.near_pairs(kR1, kR2, 1).front();
    fleet.align(i, j, kR1, Eigen::Vector3d(metres, 0.0, 0.0));
  }
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const PriorGating gating = gate_by_prior(reduced.candidates, prior.solved());
  std::size_t grouped = 0, compatible = 0;
  for (const auto& [frames, group] : gating.groups) {
    grouped += group.size();
    compatible += gating.compatible.at(frames).size();
    for (const std::size_t c : group) EXPECT_EQ(reduced.candidates[c].frames, frames);
    EXPECT_TRUE(std::ranges::includes(group, gating.compatible.at(frames)));
  }
  EXPECT_EQ(grouped + gating.gated_out.size(), reduced.candidates.size());
  EXPECT_EQ(compatible + gating.contradicting.size(), reduced.candidates.size());
  EXPECT_TRUE(std::ranges::includes(gating.contradicting, gating.gated_out));
  EXPECT_GT(gating.contradicting.size(), gating.gated_out.size()) << "between the two gates";
}

}  // namespace
}  // namespace fleetmap::graph
