#include "rejection/neighbour_votes.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::kOneRow;
using testing::kR1;
using testing::kR2;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

/// Two robots with alignments at the given translations, in the order of the track.
SimulatedFleet aligned_at(const std::vector<Eigen::Vector3d>& shifts, double gps_sigma) {
  SimulatedFleetConfig config;
  config.robots = 2;
  config.gps_sigma = gps_sigma;
  SimulatedFleet fleet(4, config);
  fleet.alignments.clear();
  const auto pairs = fleet.near_pairs(kR1, kR2, 1);
  for (std::size_t k = 0; k < shifts.size(); ++k)
    fleet.align(pairs[k].first, pairs[k].second, kR1, shifts[k]);
  return fleet;
}

TEST(NeighbourVotes, AFalseOneAmongTrueOnesIsRejectedEvenWhereGpsTellsNothing) {
  std::vector<Eigen::Vector3d> shifts(7, Eigen::Vector3d::Zero());
  shifts[3] = kOneRow;
  for (const double sigma : {1.5, 20.0}) {
    const SimulatedFleet fleet = aligned_at(shifts, sigma);
    const ReducedFleet reduced(fleet);
    const PriorSolution prior(reduced);
    const Indices group = reduced.between(kR1, kR2);
    ASSERT_EQ(group.size(), shifts.size());
    const auto votes = neighbour_votes(reduced.candidates, group, prior.solved());
    EXPECT_EQ(votes[3].contradicting, 4);
    EXPECT_EQ(votes[3].consistent, 0);
    EXPECT_EQ(votes[2].contradicting, 1);
    EXPECT_EQ(votes[2].consistent, 3);
    EXPECT_EQ(votes[0].consistent, 2) << "the first one has neighbours on one side";
    PriorGating gating;
    gating.groups[reduced.candidates.front().frames] = group;
    gating.compatible = gating.groups;
    EXPECT_EQ(rejected_by_neighbours(reduced.candidates, gating, prior.solved()),
              std::set<std::size_t>{group[3]});
  }
}

TEST(NeighbourVotes, VotesThatRejectAllCompatibleOnesDecideNothing) {
  const std::vector<Eigen::Vector3d> shifts{
      {3.0, 2.0, 0.0}, {0.0, 0.0, 0.0}, {-2.0, -4.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 5.0, 0.0}};
  const SimulatedFleet fleet = aligned_at(shifts, 5.0);
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  const FramePair frames = reduced.candidates.front().frames;
  PriorGating gating;
  gating.groups[frames] = gating.compatible[frames] = reduced.between(kR1, kR2);
  EXPECT_TRUE(rejected_by_neighbours(reduced.candidates, gating, prior.solved()).empty());
  gating.compatible[frames].clear();
  EXPECT_TRUE(rejected_by_neighbours(reduced.candidates, gating, prior.solved()).empty());
}

}  // namespace
}  // namespace fleetmap::graph
