#include "rejection/agent_check.hpp"

#include <gtest/gtest.h>

#include "graph/placed_fleet.hpp"
#include "graph/reduced_fleet.hpp"
#include "graph/torn_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::evidence_of;
using testing::kR1;
using testing::kR2;
using testing::kR4;
using testing::PriorSolution;
using testing::ReducedFleet;
using testing::SimulatedFleet;

std::optional<AgentId> found(const SimulatedFleet& fleet) {
  const ReducedFleet reduced(fleet);
  const PriorSolution prior(reduced);
  return contradicting_agent(reduced.problem(), evidence_of(reduced, prior), prior.solved());
}

TEST(AgentCheck, FindsTheOneWhoseAlignmentsTearTheOthersApart) {
  for (unsigned seed = 1; seed <= 5; ++seed) EXPECT_EQ(found(testing::torn_fleet(seed, 6.0)), kR4) << seed;
}

TEST(AgentCheck, FindsNobodyInAnHonestFleet) {
  for (unsigned seed = 1; seed <= 10; ++seed) EXPECT_EQ(found(testing::torn_fleet(seed, 0.0)), std::nullopt);
}

TEST(AgentCheck, OneFalsePairIsNoCaseAgainstEitherRobot) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulatedFleet fleet = testing::torn_fleet(seed, 0.0);
    testing::displace(fleet, kR1, kR2, testing::kOneRow);
    EXPECT_EQ(found(fleet), std::nullopt) << seed;
  }
}

}  // namespace
}  // namespace fleetmap::graph
