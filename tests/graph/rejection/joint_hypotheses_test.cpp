#include "rejection/joint_hypotheses.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/chi_squared.hpp>

#include "graph/reduced_fleet.hpp"
#include "graph/torn_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::evidence_of;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

TEST(JointHypotheses, TheQuantileIsThatOfChiSquared) {
  for (double freedom = 3.0; freedom <= 300.0; freedom += 3.0) {
    const double exact =
        boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedom), 1e-5));
    const double within = freedom < 6.0 ? 0.055 : freedom < 30.0 ? 0.03 : 0.006;
    EXPECT_NEAR(rare_chi_squared(freedom) / exact, 1.0, within) << freedom;
  }
}

/// The best hypothesis of each pair of robots, of which GPS alone contradicts none.
std::vector<Hypothesis> best_of_all(const PriorEvidence& evidence) {
  std::vector<Hypothesis> best;
  for (const auto& [frames, sets] : evidence.sets)
    if (frames.first != frames.second && !sets.hypotheses.empty()) best.push_back(sets.hypotheses.front());
  return best;
}

TEST(JointHypotheses, AllPairsAreConsistentUnlessOneRobotTearsTheOthersApart) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const bool is_false : {false, true}) {
      const SimulatedFleet fleet = testing::torn_fleet(seed, is_false ? 6.0 : 0.0);
      const ReducedFleet reduced(fleet);
      const PriorSolution prior(reduced);
      const auto best = best_of_all(evidence_of(reduced, prior));
      ASSERT_GE(best.size(), 4u) << "seed " << seed;
      for (const std::size_t members : {1u, 4u}) {
        const JointHypotheses joint(reduced.candidates, best, prior.solved(), members);
        EXPECT_EQ(joint.are_consistent(joint.select([](std::size_t) { return true; })), !is_false)
            << seed << ", " << members << " members";
        for (std::size_t k = 0; k < joint.size(); ++k)
          EXPECT_TRUE(joint.are_consistent(std::array{k})) << "GPS alone contradicts none";
      }
    }
  }
}

}  // namespace
}  // namespace fleetmap::graph
