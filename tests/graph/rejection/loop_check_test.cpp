#include "rejection/loop_check.hpp"

#include <gtest/gtest.h>

#include <set>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::evidence_of;
using testing::kOneRow;
using testing::kR1;
using testing::kR2;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

std::vector<Hypothesis> joining(const std::vector<FramePair>& pairs) {
  std::vector<Hypothesis> hypotheses;
  for (const FramePair& frames : pairs) hypotheses.emplace_back().frames = frames;
  return hypotheses;
}

TEST(LoopCheck, ThePathIsTheShortestThatIsNotDirect) {
  const auto all = joining({{0, 1}, {0, 2}, {1, 2}, {2, 3}, {3, 4}, {1, 4}});
  const std::vector<Hypothesis> triangle_fleet = path_between(all, {0, 1}, 5);
  ASSERT_EQ(triangle_fleet.size(), 2u);
  EXPECT_EQ(triangle_fleet[0].frames, FramePair(1, 2));
  EXPECT_EQ(triangle_fleet[1].frames, FramePair(0, 2));
  EXPECT_EQ(path_between(all, {1, 4}, 5).size(), 3u);
  EXPECT_TRUE(path_between(joining({{0, 1}}), {0, 1}, 2).empty()) << "only the direct one";
  EXPECT_TRUE(path_between(joining({{0, 1}, {2, 3}}), {0, 3}, 4).empty()) << "not connected";
}

SimulatedFleet triangle_fleet(unsigned seed, double gps_sigma) {
  SimulatedFleetConfig config;
  config.reach = 50.0;
  config.lanes = 6;
  config.length = 120.0;
  config.gps_sigma = gps_sigma;
  config.filtered = true;
  SimulatedFleet fleet(seed, config);
  for (Alignment& a : fleet.alignments) {
    if (std::set{a.i.agent, a.j.agent} != std::set{kR1, kR2}) continue;
    Pose T = fleet.truth.at(a.j);
    T.pretranslate(kOneRow);
    a.modes = {fleet.observed_at(a.i, T)};
  }
  return fleet;
}

TEST(LoopCheck, TheFalseSideOfATriangleIsAlwaysAnOutlierCandidate) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const double sigma : {0.5, 1.5, 5.0}) {
      const SimulatedFleet fleet = triangle_fleet(seed, sigma);
      const ReducedFleet reduced(fleet);
      const PriorSolution prior(reduced);
      const PriorEvidence evidence = evidence_of(reduced, prior);
      std::vector<Hypothesis> loop;
      for (const auto& [frames, sets] : evidence.sets) {
        const auto& some = sets.hypotheses.empty() ? sets.rejected : sets.hypotheses;
        loop.push_back(some.front());
      }
      ASSERT_EQ(loop.size(), 3u);
      const FramePair false_side = reduced.candidates[reduced.between(kR1, kR2).front()].frames;
      const auto outliers = outlier_candidates(reduced.candidates, loop, prior.solved());
      const bool found =
          std::ranges::any_of(outliers, [&](const Hypothesis& one) { return one.frames == false_side; });
      EXPECT_TRUE(found) << seed << ", GPS of " << sigma;
      if (sigma < 1.0) {
        EXPECT_EQ(outliers.size(), 1u) << "GPS decides, seed " << seed;
      }
    }
  }
}

LoopCheck check(const ReducedFleet& reduced) {
  const PriorSolution prior(reduced);
  const PriorEvidence evidence = evidence_of(reduced, prior);
  std::vector<GraphSolver::Ends> pairs;
  for (const Candidate& candidate : reduced.candidates)
    pairs.emplace_back(candidate.factor.a, candidate.factor.b);
  GraphSolver solver(reduced.graph, pairs);
  JoinedFrames joined = join_frames(reduced.problem(), evidence, {}, prior.solved().estimate, solver);
  return check_loops(reduced.problem(), evidence, prior.solved(), std::move(joined), solver);
}

TEST(LoopCheck, LoopsThatCloseAreLeftAsTheyAre) {
  SimulatedFleetConfig config;
  config.reach = 50.0;
  const SimulatedFleet fleet(3, config);
  const LoopCheck result = check(ReducedFleet(fleet));
  EXPECT_FALSE(result.repeated);
  EXPECT_TRUE(result.exclusions.candidates.empty());
  EXPECT_TRUE(result.joined.solved);
}

TEST(LoopCheck, NothingOfAFalseSideIsAccepted) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SimulatedFleet fleet = triangle_fleet(seed, 1.5);
    const ReducedFleet reduced(fleet);
    const LoopCheck result = check(reduced);
    const FramePair false_side = reduced.candidates[reduced.between(kR1, kR2).front()].frames;
    for (const auto& [alignment, c] : result.joined.accepted)
      EXPECT_NE(reduced.candidates[c].frames, false_side) << seed;
    for (const std::size_t c : result.exclusions.undecided)
      EXPECT_TRUE(result.exclusions.candidates.contains(c));
  }
}

}  // namespace
}  // namespace fleetmap::graph
