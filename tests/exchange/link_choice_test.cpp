// Messages to robots within reach of the short range leave the radio to others.
#include <gtest/gtest.h>

#include <algorithm>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using messages::Digest;
using messages::Hold;
using testing::agent;
using testing::kThree;
using testing::SimFleet;

/// Messages of these kinds that went over `reach`.
template <class... Kinds>
std::size_t sent_over(const SimFleet& fleet, Reach reach) {
  return static_cast<std::size_t>(std::ranges::count_if(fleet.sent(), [&](const SimFleet::Sent& sent) {
    return sent.outgoing.reach == reach && (std::holds_alternative<Kinds>(sent.outgoing.message) || ...);
  }));
}

TEST(LinkChoice, messages_for_a_near_robot_leave_the_radio_to_others) {
  SimFleet fleet({"r1", "r2", "r3"}, {}, 51);
  // r1 and r2 drive beside each other, r3 is out of their Wi-Fi's reach.
  fleet.reachable = [](const AgentId& from, const AgentId& to, Reach reach) {
    return reach == Reach::kLongRange || (from.str() != "r3" && to.str() != "r3");
  };
  for (const auto& name : kThree) fleet.start(name);
  drive(fleet, {"r1", "r2"}, 30);
  EXPECT_GE(fleet.robot("r1").store->alignments().size(), 2u);
  EXPECT_GT((sent_over<CloudFragment>(fleet, Reach::kShortRange)), 40u);
  EXPECT_EQ((sent_over<CloudFragment, CloudRequest, ProximityMatch>(fleet, Reach::kLongRange)), 0u);
  fleet.run_for(std::chrono::seconds(20), [&] { return fleet.equal_sets(60); });
  EXPECT_TRUE(fleet.equal_sets(60)) << "r3 has heard of all by radio";
}

TEST(LinkChoice, goes_on_over_the_short_range_when_the_radio_is_down) {
  SimFleet fleet({"r1", "r2", "r3"}, {.loss = 0.05}, 53);
  // r2 is within reach of both others: what r1 makes comes to r3 through it.
  fleet.reachable = [](const AgentId& from, const AgentId& to, Reach reach) {
    return reach == Reach::kShortRange && (from.str() == "r2" || to.str() == "r2");
  };
  for (const auto& name : kThree) fleet.start(name);
  drive(fleet, kThree, 20);
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(60); });
  EXPECT_TRUE(fleet.equal_sets(60));
  EXPECT_GE(fleet.robot("r1").store->alignments().size(), 2u);
}

TEST(LinkChoice, the_radio_is_silent_but_for_orders_when_the_whole_fleet_is_near) {
  SimFleet fleet({"r1", "r2"}, {}, 57);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (const char* name : {"r1", "r2"}) fleet.start(name);
  fleet.run_for(std::chrono::seconds(5));
  fleet.forget_sent();
  drive(fleet, {"r1", "r2"}, 20);
  EXPECT_TRUE(fleet.equal_sets(40));
  EXPECT_EQ((sent_over<graph::Node, graph::Alignment, Digest, CloudFragment, AgentStatus>(fleet,
                                                                                          Reach::kLongRange)),
            0u);
  fleet.robot("r1").exchange->on_local_order(
      messages::HoldOrder{{}, {}, agent("r1"), messages::HoldOrder::Kind::kHold}, fleet.now());
  fleet.run_for(std::chrono::seconds(5));
  EXPECT_GT((sent_over<Hold>(fleet, Reach::kLongRange)), 0u);
}

TEST(LinkChoice, a_short_range_that_works_one_way_takes_nothing_from_the_radio) {
  SimFleet fleet({"r1", "r2"}, {}, 59);
  fleet.reachable = [](const AgentId& from, const AgentId&, Reach reach) {
    return reach == Reach::kLongRange || from.str() == "r2";
  };
  for (const char* name : {"r1", "r2"}) fleet.start(name);
  drive(fleet, {"r1", "r2"}, 30);
  fleet.run_for(std::chrono::seconds(20), [&] { return fleet.equal_sets(60); });
  EXPECT_TRUE(fleet.equal_sets(60));
  EXPECT_GE(fleet.robot("r1").store->alignments().size(), 2u);
  EXPECT_GT((sent_over<CloudFragment>(fleet, Reach::kLongRange)), 20u);
  EXPECT_EQ((sent_over<CloudFragment, CloudRequest, ProximityMatch>(fleet, Reach::kShortRange)), 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
