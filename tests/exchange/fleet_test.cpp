#include <gtest/gtest.h>

#include <random>
#include <set>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using messages::Digest;
using messages::ItemRequest;
using testing::agent;
using testing::kThree;
using testing::SimFleet;

bool has_ended(const SimFleet& fleet, std::size_t nodes) {
  return fleet.equal_sets(nodes) && fleet.all([&](const auto& robot) {
    return robot.exchange->fleet_caught_up() && robot.exchange->idle(fleet.now());
  });
}

TEST(Fleet, ends_with_equal_sets_whatever_the_network_loses) {
  for (std::uint32_t seed = 0; seed < 9; ++seed) {
    SimFleet::Network network;
    network.loss = std::array{0.0, 0.1, 0.3}[seed % 3];
    network.duplication = 0.05;
    network.max_delay = std::chrono::milliseconds(400);
    SimFleet fleet(kThree, network, seed);
    for (const auto& name : kThree) fleet.start(name);
    drive(fleet, kThree, 20);
    fleet.run_for(std::chrono::minutes(20), [&] { return has_ended(fleet, 60); });
    EXPECT_TRUE(has_ended(fleet, 60)) << "seed " << seed;
    EXPECT_GE(fleet.robot("r1").store->alignments().size(), 3u) << "seed " << seed;
    // Every cloud that was asked for came whole, or is counted as lost or no longer wanted.
    for (const auto& [name, robot] : fleet.robots()) {
      const auto stats = robot.cloud_client->stats();
      EXPECT_EQ(stats.requested, robot.received.size() + stats.lost + stats.ended_by_peer + stats.yielded);
      for (const auto& [candidate, cloud] : robot.received) {
        const auto& source = fleet.robots().at(candidate.source.agent);
        EXPECT_EQ(cloud, source.clouds.at(candidate.source));
      }
      if (network.loss == 0.0) {
        EXPECT_EQ(stats.lost, 0u);
      }
    }
  }
}

TEST(Fleet, a_robot_says_that_it_is_busy_while_it_drives_and_while_a_pair_of_it_waits) {
  SimFleet fleet(kThree, {}, 3);
  for (const auto& name : kThree) fleet.start(name);
  const auto told = [&] { return fleet.robot("r3").exchange->others_busy(fleet.now()); };
  fleet.run_for(std::chrono::seconds(15));
  EXPECT_FALSE(told());
  AgentStatus driving;
  driving.busy = true;
  fleet.robot("r1").exchange->set_status(driving);
  fleet.run_for(std::chrono::seconds(60), told);
  EXPECT_TRUE(told());
  fleet.robot("r1").exchange->set_status({});
  fleet.run_for(std::chrono::seconds(60), [&] { return !told(); });
  EXPECT_FALSE(told());
  // A pair of r1 and r2, of which r3 knows nothing but the nodes.
  fleet.add_node("r1", 0.0);
  fleet.add_node("r2", 1.0);
  fleet.run_for(std::chrono::seconds(60), told);
  EXPECT_TRUE(told());
  fleet.run_for(std::chrono::minutes(3), [&] { return !told(); });
  EXPECT_FALSE(told());
  EXPECT_GE(fleet.robot("r3").store->alignments().size(), 1u) << "so r3 has it";
  fleet.robot("r1").exchange->set_status(driving);
  fleet.run_for(std::chrono::seconds(60), told);
  fleet.kill("r1");
  fleet.run_for(std::chrono::seconds(20));
  EXPECT_FALSE(told()) << "its word does not outlive it";
}

TEST(Fleet, each_robot_has_the_last_status_and_the_last_answer_to_an_order_of_every_other) {
  using messages::Hold;
  SimFleet fleet(kThree, {}, 3);
  for (const auto& name : kThree) fleet.start(name);
  exchange::Exchange& first = *fleet.robot("r1").exchange;
  EXPECT_EQ(first.statuses().size(), 1u) << "the own one";
  fleet.robot("r2").exchange->set_drives(true);
  AgentStatus status;
  status.battery = 0.25f;
  fleet.robot("r2").exchange->set_status(status);
  fleet.add_node("r2", 0.0);
  const AgentId r1 = AgentId::parse("r1").value(), r2 = AgentId::parse("r2").value();
  fleet.run_for(std::chrono::seconds(60), [&] {
    return first.statuses().size() == 3 && first.statuses().at(r2).nodes == 1 &&
           first.statuses().at(r1).nodes == 1;
  });
  EXPECT_EQ(first.statuses().at(r2).battery, 0.25f);
  EXPECT_EQ(first.statuses().at(r2).nodes, 1u);
  EXPECT_EQ(first.statuses().at(r1).nodes, 1u);
  EXPECT_TRUE(first.hold_orders().empty());
  EXPECT_EQ(first.driving().size(), 1u) << "nobody answers without an order";
  first.on_local_order(messages::HoldOrder{{}, r2, r1, messages::HoldOrder::Kind::kHold}, fleet.now());
  fleet.run_for(std::chrono::seconds(60), [&] { return first.driving().size() == 3; });
  EXPECT_EQ(first.driving().at(r2), Hold::Driving::kHeld);
  EXPECT_EQ(first.driving().at(r1), Hold::Driving::kNoMission);
  ASSERT_EQ(first.hold_orders().size(), 1u);
  EXPECT_EQ(first.hold_orders()[0].kind, messages::HoldOrder::Kind::kHold);
  first.on_local_order(messages::HoldOrder{{}, r2, r1, messages::HoldOrder::Kind::kResume}, fleet.now());
  fleet.run_for(std::chrono::seconds(60), [&] { return first.driving().at(r2) == Hold::Driving::kFree; });
  EXPECT_EQ(first.driving().at(r2), Hold::Driving::kFree);
}

TEST(Fleet, a_late_joiner_gets_everything_and_meets_the_others) {
  SimFleet fleet(kThree, {.loss = 0.1}, 11);
  fleet.start("r1");
  fleet.start("r2");
  drive(fleet, {"r1", "r2"}, 80);
  fleet.start("r3");
  fleet.add_node("r3", 40.0);
  fleet.run_for(std::chrono::minutes(20), [&] { return has_ended(fleet, 161); });
  ASSERT_TRUE(has_ended(fleet, 161));
  EXPECT_GE(fleet.robot("r3").received.size(), 2u);  // one of r1 and one of r2
}

TEST(Fleet, items_of_an_absent_robot_are_passed_on) {
  SimFleet fleet(kThree, {.loss = 0.2}, 13);
  fleet.start("r1");
  fleet.start("r2");
  drive(fleet, {"r1"}, 30);
  fleet.run_for(std::chrono::minutes(2), [&] { return fleet.equal_sets(30); });
  fleet.kill("r1");
  fleet.start("r3");
  fleet.run_for(std::chrono::minutes(5), [&] { return fleet.equal_sets(30); });
  EXPECT_TRUE(fleet.equal_sets(30));
}

TEST(Fleet, a_partition_heals) {
  SimFleet fleet(kThree, {}, 17);
  bool cut = true;
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach reach) {
    const bool across = (from == agent("r3")) != (to == agent("r3"));
    return reach == Reach::kLongRange && !(cut && across);
  };
  for (const auto& name : kThree) fleet.start(name);
  drive(fleet, kThree, 30);
  EXPECT_FALSE(fleet.equal_sets(90));
  cut = false;
  fleet.run_for(std::chrono::minutes(10), [&] { return has_ended(fleet, 90); });
  EXPECT_TRUE(has_ended(fleet, 90));
}

TEST(Fleet, kills_at_any_time_lose_nothing) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    SimFleet fleet(kThree, {.loss = 0.1, .duplication = 0.1}, seed);
    for (const auto& name : kThree) fleet.start(name);
    for (int k = 0; k < 12; ++k) {
      drive(fleet, kThree, 1, 4.0 * k);
      fleet.run_for(std::chrono::milliseconds(random() % 3000));
      const auto& victim = kThree[random() % 3];
      fleet.kill(victim);
      fleet.run_for(std::chrono::milliseconds(random() % 4000));
      fleet.start(victim);
    }
    fleet.run_for(std::chrono::minutes(20), [&] { return has_ended(fleet, 36); });
    EXPECT_TRUE(has_ended(fleet, 36)) << "seed " << seed;
    EXPECT_GE(fleet.robot("r1").store->alignments().size(), 2u) << "seed " << seed;
    for (const auto& [name, robot] : fleet.robots()) EXPECT_EQ(robot.store->stats().conflicts, 0u);
  }
}

TEST(Fleet, items_of_a_lost_robot_alone_are_not_waited_for) {
  SimFleet fleet(kThree, {}, 23);
  std::set<AgentId> near{agent("r2"), agent("r3")};
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach reach) {
    return reach == Reach::kLongRange || (near.contains(from) && near.contains(to));
  };
  for (const auto& name : kThree) fleet.start(name);
  drive(fleet, kThree, 5);
  fleet.run_for(std::chrono::minutes(1));
  near.clear();
  drive(fleet, {"r3"}, 2, 20.0);  // all hear of these nodes, nobody gets their submaps
  fleet.run_for(std::chrono::minutes(1));
  fleet.kill("r3");
  const std::set<AgentId> lost{agent("r3")};
  const auto done = [&](const SimFleet::Robot& robot) {
    return robot.exchange->complete(lost) && robot.exchange->fleet_caught_up(lost) &&
           robot.exchange->idle(fleet.now(), lost);
  };
  fleet.run_for(std::chrono::minutes(2));
  EXPECT_FALSE(done(fleet.robot("r1"))) << "r2 may have what r1 lacks, as far as r1 knows";
  near = {agent("r1"), agent("r2")};
  fleet.run_for(std::chrono::minutes(5), [&] { return fleet.all(done); });
  EXPECT_TRUE(fleet.all(done));
  EXPECT_FALSE(fleet.robot("r1").exchange->complete()) << "should it come back, it is asked";
  const store::Store& r1 = *fleet.robot("r1").store;
  EXPECT_EQ(r1.nodes().size(), 17u);
  EXPECT_EQ(r1.submap_set().size(), 15u) << "with those of r3 that r2 had";
  EXPECT_TRUE(r1.submap_set() == fleet.robot("r2").store->submap_set());
}

TEST(Fleet, tries_elsewhere_when_registrations_are_rejected) {
  SimFleet fleet({"r1", "r2"}, {}, 23);
  int registrations = 0;
  fleet.registration = [&](const NodePair&) {
    return ++registrations > 4 ? std::optional(0.2) : std::nullopt;
  };
  fleet.start("r1");
  fleet.start("r2");
  drive(fleet, {"r1", "r2"}, 30);
  EXPECT_FALSE(fleet.robot("r1").store->alignments().empty());
}

TEST(Fleet, refuses_strangers_and_reports_a_taken_name) {
  SimFleet fleet({"r1", "r2"}, {}, 29);
  fleet.start("r1");
  auto& robot = fleet.robot("r1");
  robot.exchange->on_message(testing::make_node(agent("x"), 0, Bytes{}), fleet.now());
  robot.exchange->on_message(Digest{agent("x"), {{agent("r2"), 0, 5}}, {}}, fleet.now());
  robot.exchange->on_message(Digest{agent("r1"), {{agent("r2"), 0, 5}}, {}}, fleet.now());
  robot.exchange->on_message(Digest{agent("r2"), {{agent("x"), 0, 5}}, {}}, fleet.now());
  robot.exchange->on_message(AgentStatus{agent("x"), {}, {}}, fleet.now());
  EXPECT_EQ(robot.exchange->stats().strangers, 5u);
  const auto told = robot.exchange->take_events();
  ASSERT_EQ(told.size(), 1u) << "once of each";
  EXPECT_EQ(std::get<StrangerHeard>(told[0]).name, agent("x"));
  EXPECT_TRUE(robot.exchange->complete());
  robot.exchange->on_message(testing::make_node(agent("r2"), 0, Bytes{}, 0.0, 1), fleet.now());
  robot.exchange->on_message(testing::make_node(agent("r2"), 0, Bytes{}, 0.0, 2), fleet.now());
  const auto events = robot.exchange->take_events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(std::get<ItemConflict>(events[1]).id, (NodeId{agent("r2"), 0}));
  // A hostile digest and requests cost neither time nor memory.
  robot.exchange->on_message(Digest{agent("r2"), {{agent("r2"), 0, UINT32_MAX}, {agent("r2"), 9, 3}}, {}},
                             fleet.now());
  robot.exchange->on_message(ItemRequest{agent("r2"), agent("r1"), {{agent("r2"), 0, 9'999'999}}, {}},
                             fleet.now());
  robot.exchange->on_message(CloudRequest{agent("r2"), agent("r1"), {agent("r2"), 0}, {}}, fleet.now());
  EXPECT_EQ(robot.exchange->stats().reconcile.hostile, 2u);
  EXPECT_EQ(robot.exchange->stats().bad_requests, 1u);
  EXPECT_EQ(robot.exchange->queue().size(Priority::kBackfill), 2u) << "both contents of the taken name";
}

TEST(Fleet, takes_no_items_of_its_own_session_from_others) {
  SimFleet fleet({"r1", "r2"}, {}, 47);
  fleet.start("r1", 9);
  auto& robot = fleet.robot("r1");
  const graph::Node own = fleet.add_node("r1", 0.0);
  robot.exchange->take_events();
  const auto hear = [&](const Message& message) {
    robot.exchange->on_message(message, fleet.now());
    return robot.exchange->take_events();
  };
  EXPECT_TRUE(hear(own).empty()) << "an echo";
  const auto forged = testing::make_node(agent("r1"), first_seq(9) + 9'999, Bytes{});
  const auto events = hear(forged);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::get<ItemConflict>(events[0]).id, forged.id);
  const auto alignment = testing::make_alignment(own.id, {agent("r2"), 0}, agent("r1"), first_seq(9) + 5);
  EXPECT_EQ(hear(alignment).size(), 1u);
  EXPECT_EQ(fleet.add_node("r1", 4.0).id.seq, own.id.seq + 1) << "its own names are still its own";
  EXPECT_EQ(robot.store->next_alignment_seq(9), first_seq(9));
  EXPECT_EQ(hear(testing::make_node(agent("r1"), first_seq(8), Bytes{})).size(), 1u);
  EXPECT_EQ(robot.store->nodes().size(), 3u) << "of an earlier session: given back";
}

TEST(Fleet, configuration_names_what_is_wrong) {
  const testing::TemporaryFolder folder;
  auto store = store::Store::open(folder / "store.db", agent("r1")).value();
  ExchangeConfig config;
  config.payload_size = testing::payload_size;
  loop_closure::CandidateScheduler cloud_client(agent("r1"), {});
  EXPECT_FALSE(Exchange::make(config, store, cloud_client, {}));
  config.fleet = {agent("r1"), agent("r2")};
  EXPECT_TRUE(Exchange::make(config, store, cloud_client, {}));
  config.long_range.fleet_bytes_per_second = 0.0;
  const auto refused = Exchange::make(config, store, cloud_client, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("long_range.fleet_bytes_per_second"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::exchange
