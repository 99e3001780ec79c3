// The long-range radio: what a fleet sends stays within the budget of all, and small messages go first.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::Digest;
using testing::agent;
using testing::kThree;
using testing::SimFleet;

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

TEST(FleetBudget, keeps_the_budget_of_the_radio_in_every_window) {
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

TEST(ForFleet, ASmallFleetOnTheUsualBudgetKeepsItsPeriods) {
  ExchangeConfig config;
  for (const char* name : {"r1", "r2", "r3", "r4", "r5"}) config.fleet.push_back(agent(name));
  EXPECT_EQ(for_fleet(config).status_period, config.status_period);
  config.long_range.fleet_bytes_per_second /= 3.0;
  EXPECT_NEAR(to_seconds(for_fleet(config).status_period), 3.0 * to_seconds(config.status_period), 1e-6);
}

TEST(FleetBudget, small_messages_do_not_wait_behind_clouds) {
  SimFleet fleet({"r1", "r2"}, {}, 7, {}, [](loop_closure::CandidateConfig& config) {
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

TEST(FleetBudget, falls_silent_but_for_digests_and_status_when_all_is_done) {
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

}  // namespace
}  // namespace fleetmap::exchange
