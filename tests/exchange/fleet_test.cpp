#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using messages::Digest;
using messages::Hold;
using messages::ItemRequest;
using testing::agent;
using testing::SimFleet;

const std::vector<std::string> kThree{"r1", "r2", "r3"};

/// Three robots on parallel tracks 8 m apart, a node every 2 s and 4 m.
void drive(SimFleet& fleet, const std::vector<std::string>& names, int nodes, double start_m = 0.0) {
  for (int k = 0; k < nodes; ++k) {
    double offset = 0.0;
    for (const auto& name : names) fleet.add_node(name, start_m + 4.0 * k + (offset += 1.0));
    fleet.run_for(std::chrono::seconds(2));
  }
}

bool settled(const SimFleet& fleet, std::size_t nodes) {
  return fleet.equal_sets(nodes) && fleet.all([&](const auto& robot) {
    return robot.exchange->fleet_caught_up() && robot.exchange->idle(fleet.now());
  });
}

/// The most wire bytes that all agents together sent in any window beginning at a message.
double worst_excess(const SimFleet& fleet, Duration window, double rate) {
  double worst = -1e18;
  std::deque<const SimFleet::Sent*> inside;
  double sum = 0.0;
  for (const auto& sent : fleet.sent()) {
    if (sent.outgoing.reach != Reach::kLongRange) continue;
    inside.push_back(&sent);
    sum += static_cast<double>(sent.wire_bytes);
    while (inside.front()->at + window < sent.at) {
      sum -= static_cast<double>(inside.front()->wire_bytes);
      inside.pop_front();
    }
    worst = std::max(worst, sum - rate * to_seconds(window));
  }
  return worst;
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
    fleet.run_for(std::chrono::minutes(20), [&] { return settled(fleet, 60); });
    EXPECT_TRUE(settled(fleet, 60)) << "seed " << seed;
    EXPECT_GE(fleet.robot("r1").store->alignments().size(), 3u) << "seed " << seed;
    // Every cloud that was asked for came whole, or is counted as lost or no longer wanted.
    for (const auto& [name, robot] : fleet.robots()) {
      const auto stats = robot.loop_closer->stats();
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

TEST(Fleet, keeps_the_budget_of_the_radio_in_every_window) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const std::vector<std::string> names =
        seed % 2 ? std::vector<std::string>{"r1", "r2", "r3", "r4", "r5"} : kThree;
    SimFleet::Network network;
    network.loss = 0.1 * (seed % 4);
    SimFleet fleet(names, network, seed);
    for (const auto& name : names) fleet.start(name);
    drive(fleet, names, 15);
    fleet.run_for(std::chrono::minutes(2));
    const double rate = fleet.config().long_range.fleet_bytes_per_second;
    // A message to all that is larger than the burst goes when the bucket is full.
    std::size_t largest = 0;
    for (const auto& sent : fleet.sent()) {
      if (sent.outgoing.reach == Reach::kLongRange) largest = std::max(largest, sent.wire_bytes);
    }
    const double bursts =
        static_cast<double>(names.size()) *
        std::max(fleet.robot("r1").exchange->queue().burst_bytes(), static_cast<double>(largest));
    for (const int seconds : {0, 1, 3, 10, 30}) {
      EXPECT_LE(worst_excess(fleet, std::chrono::seconds(seconds), rate), bursts + 1.0) << "seed " << seed;
    }
    // The link was put to use: this is no test of silence.
    EXPECT_GT(worst_excess(fleet, std::chrono::seconds(10), rate), -0.8 * rate * 10.0) << "seed " << seed;
  }
}

TEST(Fleet, a_robot_says_that_it_is_busy_while_it_drives_and_while_a_pair_of_it_ripens) {
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

TEST(ForFleet, ASmallFleetOnTheUsualBudgetKeepsItsPeriods) {
  ExchangeConfig config;
  for (const char* name : {"r1", "r2", "r3", "r4", "r5"}) config.fleet.push_back(agent(name));
  EXPECT_EQ(for_fleet(config).status_period, config.status_period);
  config.long_range.fleet_bytes_per_second /= 3.0;
  EXPECT_NEAR(to_seconds(for_fleet(config).status_period), 3.0 * to_seconds(config.status_period), 1e-6);
}

TEST(Fleet, small_messages_do_not_wait_behind_clouds) {
  SimFleet fleet({"r1", "r2"}, {}, 7, {}, [](loop_closure::LoopClosureConfig& config) {
    config.spacing_m = config.spacing_aligned_m = 0.0;  // as many clouds as will go
    config.stop_when_peer_aligned = false;
    config.max_active = 6;
  });
  fleet.start("r1");
  fleet.start("r2");
  std::map<NodeId, Stamp> made;
  for (int k = 0; k < 60; ++k) {
    made[fleet.add_node("r1", 2.0 * k).id] = fleet.now();
    made[fleet.add_node("r2", 2.0 * k + 1.0).id] = fleet.now();
    fleet.run_for(std::chrono::milliseconds(1980));
  }
  std::vector<double> waits;
  double cloud_bytes = 0.0;
  for (const auto& sent : fleet.sent()) {
    if (const auto* node = std::get_if<graph::Node>(&sent.outgoing.message)) {
      waits.push_back(to_seconds(sent.at - made.at(node->id)));
    }
    if (std::holds_alternative<CloudFragment>(sent.outgoing.message))
      cloud_bytes += static_cast<double>(sent.wire_bytes);
  }
  ASSERT_GE(waits.size(), 118u);
  EXPECT_GT(cloud_bytes, 0.7 * 20'000.0 * 100.0);  // the load was there
  std::ranges::sort(waits);
  EXPECT_LE(waits[waits.size() * 95 / 100], 0.1);
  EXPECT_LE(waits.back(), 0.3);
}

TEST(Fleet, a_late_joiner_gets_everything_and_meets_the_others) {
  SimFleet fleet(kThree, {.loss = 0.1}, 11);
  fleet.start("r1");
  fleet.start("r2");
  drive(fleet, {"r1", "r2"}, 80);
  fleet.start("r3");
  fleet.add_node("r3", 40.0);
  fleet.run_for(std::chrono::minutes(20), [&] { return settled(fleet, 161); });
  ASSERT_TRUE(settled(fleet, 161));
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
  fleet.run_for(std::chrono::minutes(10), [&] { return settled(fleet, 90); });
  EXPECT_TRUE(settled(fleet, 90));
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
    fleet.run_for(std::chrono::minutes(20), [&] { return settled(fleet, 36); });
    EXPECT_TRUE(settled(fleet, 36)) << "seed " << seed;
    EXPECT_GE(fleet.robot("r1").store->alignments().size(), 2u) << "seed " << seed;
    for (const auto& [name, robot] : fleet.robots()) EXPECT_EQ(robot.store->stats().conflicts, 0u);
  }
}

TEST(Fleet, what_only_a_lost_robot_had_is_not_waited_for) {
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

TEST(Fleet, falls_silent_but_for_digests_and_status_when_all_is_done) {
  SimFleet fleet(kThree, {}, 19);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (const auto& name : kThree) fleet.start(name);
  drive(fleet, kThree, 10);
  const auto done = [&](const SimFleet::Robot& robot) {
    return robot.exchange->complete() && robot.exchange->idle(fleet.now()) &&
           robot.exchange->fleet_caught_up();
  };
  fleet.run_for(std::chrono::minutes(10), [&] { return fleet.all(done); });
  ASSERT_TRUE(fleet.all(done));
  for (const auto& [name, robot] : fleet.robots()) {
    EXPECT_TRUE(std::ranges::any_of(robot.events,
                                    [](const Event& e) { return std::holds_alternative<MapComplete>(e); }));
  }
  fleet.run_for(std::chrono::minutes(2));
  fleet.forget_sent();
  fleet.run_for(std::chrono::minutes(1));
  double bytes = 0.0;
  for (const auto& sent : fleet.sent()) {
    if (sent.outgoing.reach != Reach::kLongRange) continue;
    bytes += static_cast<double>(sent.wire_bytes);
    const auto& message = sent.outgoing.message;
    EXPECT_TRUE(std::holds_alternative<Digest>(message) || std::holds_alternative<AgentStatus>(message));
  }
  EXPECT_LT(bytes / 60.0, 0.03 * 20'000.0);
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

/// How often this robot was told that its store lacks what others have of it.
int warnings_of_lost_items(const SimFleet::Robot& robot) {
  return static_cast<int>(std::ranges::count_if(
      robot.events, [](const Event& event) { return std::holds_alternative<OwnItemsElsewhere>(event); }));
}
bool conflicts(const SimFleet::Robot& robot) {
  return std::ranges::any_of(robot.events,
                             [](const Event& event) { return std::holds_alternative<ItemConflict>(event); });
}

TEST(Fleet, a_robot_on_a_new_disk_gets_its_items_back_and_nothing_conflicts) {
  SimFleet fleet({"r1", "r2", "r3"}, {.loss = 0.05}, 41);
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  for (int k = 0; k < 17; ++k) {
    fleet.add_node("r1", 4.0 * k);
    fleet.run_for(std::chrono::seconds(1));
  }
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(17); });
  ASSERT_TRUE(fleet.equal_sets(17));
  fleet.kill("r1");
  fleet.lose_store("r1");
  fleet.start("r1", 4711);
  // It has heard nobody yet, and maps.
  for (int k = 0; k < 17; ++k) {
    fleet.add_node("r1", -4.0 * k);
    fleet.run_for(std::chrono::seconds(1));
  }
  fleet.run_for(std::chrono::seconds(180), [&] { return fleet.equal_sets(34); });
  EXPECT_TRUE(fleet.equal_sets(34)) << fleet.robot("r1").store->nodes().size();
  EXPECT_EQ(warnings_of_lost_items(fleet.robot("r1")), 1);
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

TEST(Fleet, a_robot_whose_store_is_damaged_keeps_what_is_whole_and_gets_the_rest_back) {
  SimFleet fleet({"r1", "r2", "r3"}, {}, 61);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  drive(fleet, kThree, 20);
  const auto same = [&](std::size_t nodes) {
    return fleet.equal_sets(nodes) &&
           fleet.all([&](const auto& robot) { return robot.store->submap_set().size() == nodes; });
  };
  fleet.run_for(std::chrono::minutes(2), [&] { return same(60); });
  ASSERT_TRUE(same(60));
  fleet.kill("r1");
  const std::filesystem::path file = fleet.store_file("r1");
  ASSERT_TRUE(store::Store::open(file, agent("r1"))) << "which moves the log into the file";
  {
    const auto size = static_cast<std::size_t>(std::filesystem::file_size(file));
    std::fstream damaged(file, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(static_cast<std::streamoff>(size / 3));
    const std::string hole(size / 3, '\xff');
    damaged.write(hole.data(), static_cast<std::streamsize>(hole.size()));
  }
  fleet.start("r1", 4711);
  const store::Store& store = *fleet.robot("r1").store;
  EXPECT_EQ(store.damage().size(), 1u);
  const std::size_t kept = store.submap_set().size();
  EXPECT_GE(kept, 20u);
  EXPECT_LT(kept, 60u);
  drive(fleet, {"r1"}, 5, 100.0);
  fleet.run_for(std::chrono::minutes(3), [&] { return same(65); });
  EXPECT_TRUE(same(65)) << store.nodes().size() << " nodes, " << store.submap_set().size() << " submaps";
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

TEST(Fleet, a_robot_whose_store_is_an_old_backup_gives_no_name_twice) {
  SimFleet fleet({"r1", "r2"}, {}, 43);
  fleet.start("r1");
  fleet.start("r2");
  for (int k = 0; k < 5; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(20), [&] { return fleet.equal_sets(5); });
  fleet.kill("r1");
  fleet.keep_store("r1");
  fleet.start("r1", 2);
  for (int k = 5; k < 9; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(9); });
  ASSERT_TRUE(fleet.equal_sets(9));
  fleet.kill("r1");
  fleet.put_back_store("r1");
  fleet.start("r1", 3);
  EXPECT_EQ(fleet.robot("r1").store->nodes().size(), 5u);
  for (int k = 9; k < 12; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(120), [&] { return fleet.equal_sets(12); });
  EXPECT_TRUE(fleet.equal_sets(12));
  EXPECT_EQ(warnings_of_lost_items(fleet.robot("r1")), 1);
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

/// Messages of these kinds that went over `reach`.
template <class... Kinds>
std::size_t sent_over(const SimFleet& fleet, Reach reach) {
  return static_cast<std::size_t>(std::ranges::count_if(fleet.sent(), [&](const SimFleet::Sent& sent) {
    return sent.outgoing.reach == reach && (std::holds_alternative<Kinds>(sent.outgoing.message) || ...);
  }));
}

TEST(Fleet, what_is_for_one_robot_leaves_the_radio_to_others_when_it_is_near) {
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

TEST(Fleet, goes_on_over_the_short_range_when_the_radio_is_down) {
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

TEST(Fleet, the_radio_is_silent_but_for_orders_when_the_whole_fleet_is_near) {
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
  fleet.robot("r1").exchange->on_local_order({{}, {}, agent("r1"), true}, fleet.now());
  fleet.run_for(std::chrono::seconds(5));
  EXPECT_GT((sent_over<Hold>(fleet, Reach::kLongRange)), 0u);
}

TEST(Fleet, a_short_range_that_works_one_way_takes_nothing_from_the_radio) {
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
  const testing::ScratchFolder folder;
  auto store = store::Store::open(folder / "store.db", agent("r1")).value();
  ExchangeConfig config;
  config.payload_size = testing::payload_size;
  loop_closure::CandidateScheduler loop_closer(agent("r1"), {});
  EXPECT_FALSE(Exchange::make(config, store, loop_closer, {}));
  config.fleet = {agent("r1"), agent("r2")};
  EXPECT_TRUE(Exchange::make(config, store, loop_closer, {}));
  config.long_range.fleet_bytes_per_second = 0.0;
  const auto refused = Exchange::make(config, store, loop_closer, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("long_range.fleet_bytes_per_second"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::exchange
