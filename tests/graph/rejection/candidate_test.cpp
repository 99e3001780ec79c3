#include "rejection/candidate.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kR1;
using testing::kR2;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(Candidate, EveryModeIsOneWithItsFloor) {
  SimulatedFleet fleet(1);
  fleet.alignments.front().modes.push_back(fleet.alignments.front().best());
  FleetPlacementConfig config;
  config.alignment_floor_m = 0.5;
  const ReducedFleet reduced(fleet, config);
  EXPECT_EQ(reduced.candidates.size(), fleet.alignments.size() + 1);
  for (const Candidate& candidate : reduced.candidates) {
    const AlignmentMode& mode = reduced.items.alignments[candidate.alignment]->modes[candidate.mode];
    EXPECT_DOUBLE_EQ(candidate.factor.covariance(0, 0), mode.covariance(0, 0) + 0.25);
    EXPECT_LT(candidate.frames.first, candidate.frames.second);
  }
}

TEST(Candidate, ModesOfLargeCovarianceAreLeftOutBesideCertainOnes) {
  SimulatedFleet fleet(1);
  Alignment& a = fleet.alignments.front();
  a.modes.push_back(a.best());
  a.modes.back().covariance *= 1e6;
  EXPECT_EQ(ReducedFleet(fleet).candidates.size(), fleet.alignments.size());
  a.modes.front().covariance *= 1e6;
  EXPECT_EQ(ReducedFleet(fleet).candidates.size(), fleet.alignments.size() + 1) << "no mode is certain";
}

TEST(Candidate, TheSignIsThatOfTheSecondFrameWhoeverComputedIt) {
  SimulatedFleet fleet(2);
  fleet.alignments.clear();
  const auto [i, j] = fleet.near_pairs(kR1, kR2, 1).front();
  fleet.align(i, j, kR1);
  fleet.align(j, i, kR2);
  fleet.align({kR1, 9}, {kR1, 3}, kR1);
  const ReducedFleet reduced(fleet);
  for (const Candidate& candidate : reduced.candidates) {
    const bool moves_b = candidate.factor.a < candidate.factor.b;  // poses are in the order of the frames
    EXPECT_EQ(candidate.sign, moves_b ? 1.0 : -1.0);
  }
}

}  // namespace
}  // namespace fleetmap::graph
