#include <gtest/gtest.h>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::SubmapChunk;
using messages::SubmapRequest;
using testing::SimFleet;

TEST(Correction, ANewAlignmentSendsItselfAndNoSubmapAgain) {
  const std::vector<std::string> names{"r1", "r2"};
  SimFleet fleet(names, {}, 1);
  for (const auto& name : names) fleet.start(name);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  NodePair pair;
  for (int k = 0; k < 5; ++k) {
    pair.ours = fleet.add_node("r1", 40.0 * k).id;
    pair.theirs = fleet.add_node("r2", 40.0 * k + 1.0).id;
    fleet.run_for(std::chrono::seconds(2));
  }
  const auto complete = [&] {
    return fleet.equal_sets(10) && fleet.all([&](const auto& robot) {
      return robot.store->submap_set().size() == 10 && robot.exchange->idle(fleet.now());
    });
  };
  fleet.run_for(std::chrono::minutes(10), complete);
  ASSERT_TRUE(complete());

  fleet.forget_sent();
  const std::size_t alignments = fleet.robot("r2").store->alignments().size();
  fleet.add_alignment("r1", pair, 0.1);
  fleet.run_for(std::chrono::minutes(2));
  EXPECT_EQ(fleet.robot("r2").store->alignments().size(), alignments + 1);
  std::size_t chunks = 0, clouds = 0;
  for (const auto& sent : fleet.sent()) {
    chunks += std::holds_alternative<SubmapChunk>(sent.outgoing.message) ||
              std::holds_alternative<SubmapRequest>(sent.outgoing.message);
    clouds += std::holds_alternative<CloudFragment>(sent.outgoing.message);
  }
  EXPECT_EQ(chunks, 0u);
  EXPECT_EQ(clouds, 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
