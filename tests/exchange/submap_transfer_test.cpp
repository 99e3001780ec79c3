#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <random>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::SubmapChunk;
using testing::agent;
using testing::SimFleet;

/// Lets both links through while `open`.
void link(SimFleet& fleet, const bool& open) {
  fleet.reachable = [&open](const AgentId&, const AgentId&, Reach reach) {
    return reach == Reach::kLongRange || open;
  };
}

std::uint64_t chunk_bytes_sent(const SimFleet& fleet) {
  std::uint64_t bytes = 0;
  for (const auto& sent : fleet.sent()) {
    if (const auto* chunk = std::get_if<SubmapChunk>(&sent.outgoing.message)) bytes += chunk->payload.size();
  }
  return bytes;
}

bool whole(const SimFleet::Robot& robot) { return robot.exchange->complete(); }

TEST(SubmapTransfer, fills_the_link_and_ends_with_equal_submaps) {
  SimFleet fleet({"r1", "r2"}, {}, 1);
  bool open = false;
  link(fleet, open);
  fleet.start("r1");
  fleet.start("r2");
  std::uint64_t total = 0;
  for (int k = 0; k < 40; ++k) {
    fleet.add_node("r1", 1000.0 + 5.0 * k, 100'000 + 17 * static_cast<std::size_t>(k));
    total += 100'000 + 17 * static_cast<std::uint64_t>(k);
  }
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(40); });
  ASSERT_TRUE(fleet.equal_sets(40));
  EXPECT_FALSE(fleet.robot("r2").exchange->complete());
  open = true;
  const Stamp start = fleet.now();
  fleet.run_for(std::chrono::seconds(60), [&] { return whole(fleet.robot("r2")); });
  ASSERT_TRUE(whole(fleet.robot("r2")));
  // 4 MB over 15 Mbit/s take 2.13 s; up to one digest period passes before the first request.
  const double seconds = to_seconds(fleet.now() - start);
  EXPECT_GT(static_cast<double>(total) / (seconds - 1.0), 0.85 * 1'875'000) << seconds;
  for (std::uint32_t seq = 0; seq < 40; ++seq) {
    const NodeId id{agent("r1"), seq};
    EXPECT_EQ(fleet.robot("r2").store->submap(id).value(), fleet.robot("r1").store->submap(id).value());
  }
  EXPECT_EQ(chunk_bytes_sent(fleet), total);  // without loss nothing goes twice
}

TEST(SubmapTransfer, comes_through_loss_disorder_and_doubles) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    SimFleet::Network network;
    network.loss = seed % 2 ? 0.3 : 0.1;
    network.duplication = 0.1;
    network.max_delay = std::chrono::milliseconds(200);
    SimFleet fleet({"r1", "r2", "r3"}, network, seed);
    const bool open = true;
    link(fleet, open);
    for (const char* name : {"r1", "r2", "r3"}) {
      fleet.start(name);
      for (int k = 0; k < 4; ++k) fleet.add_node(name, 1000.0 * name[1] + 5.0 * k, 60'000);
    }
    fleet.run_for(std::chrono::minutes(5), [&] { return fleet.equal_sets(12) && fleet.all(whole); });
    EXPECT_TRUE(fleet.equal_sets(12) && fleet.all(whole)) << "seed " << seed;
  }
}

TEST(SubmapTransfer, goes_on_after_cuts_and_kills_without_sending_again_what_is_held) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    SimFleet fleet({"r1", "r2"}, {}, seed);
    bool open = true;
    link(fleet, open);
    fleet.start("r1");
    fleet.start("r2");
    constexpr std::uint64_t kTotal = 5 * 700'000;
    for (int k = 0; k < 5; ++k) fleet.add_node("r1", 1000.0 + 5.0 * k, 700'000);
    std::uint64_t held_before = 0;
    for (int kills = 0; kills < 3; ++kills) {
      open = true;
      fleet.run_for(std::chrono::milliseconds(1500 + random() % 900));
      open = false;
      fleet.run_for(std::chrono::milliseconds(random() % 2000));
      const bool sender = random() % 2 == 0;
      fleet.kill(sender ? "r1" : "r2");
      fleet.start(sender ? "r1" : "r2");
      auto& store = *fleet.robot("r2").store;
      std::uint64_t held = store.submap_set().size() * 700'000;
      for (const NodeId& id : store.partial_submaps()) {
        for (std::uint32_t chunk = 0; chunk < 86; ++chunk) held += store::Store::kChunkBytes;
        for (const std::uint32_t chunk : store.missing_chunks(id))
          held -= chunk == 85 ? 0 : store::Store::kChunkBytes;
      }
      EXPECT_GE(held + store::Store::kChunkBytes * 5, held_before);
      held_before = held;
    }
    // From here on nothing is lost, so exactly the bytes that are missing are sent.
    std::uint64_t missing = 0;
    auto& store = *fleet.robot("r2").store;
    for (const auto& [id, node] : fleet.robot("r1").store->nodes()) {
      if (!store.node(id)) missing += node.submap_bytes;
      for (const std::uint32_t chunk : store.missing_chunks(id)) {
        missing += std::min(store::Store::kChunkBytes, node.submap_bytes - chunk * store::Store::kChunkBytes);
      }
    }
    ASSERT_LT(missing, kTotal);
    fleet.run_for(std::chrono::seconds(10));  // queues that were filled before the cut run dry
    fleet.forget_sent();
    open = true;
    fleet.run_for(std::chrono::minutes(1), [&] { return fleet.equal_sets(5) && whole(fleet.robot("r2")); });
    ASSERT_TRUE(whole(fleet.robot("r2"))) << "seed " << seed;
    EXPECT_EQ(chunk_bytes_sent(fleet), missing) << "seed " << seed;
  }
}

/// A chunk that is late may be taken for lost and asked of the other: of ten seeds two had up to 2 % twice.
TEST(SubmapTransfer, takes_each_chunk_from_one_peer_and_shares_the_work) {
  std::uint64_t all = 0;
  std::map<AgentId, std::uint64_t> served;
  constexpr unsigned kSeeds = 6;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SimFleet fleet({"r1", "r2", "r3"}, {}, seed, {}, testing::no_candidates);
    bool open = false;
    bool r3_reached = false;
    fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach reach) {
      const bool with_r3 = from == agent("r3") || to == agent("r3");
      return reach == Reach::kLongRange || (with_r3 ? r3_reached : open);
    };
    for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
    for (int k = 0; k < 30; ++k) fleet.add_node("r1", 5.0 * k, 100'000);
    open = true;
    fleet.run_for(std::chrono::minutes(1), [&] { return whole(fleet.robot("r2")) && fleet.equal_sets(30); });
    ASSERT_TRUE(whole(fleet.robot("r2")));
    fleet.forget_sent();
    r3_reached = true;
    fleet.run_for(std::chrono::minutes(1), [&] { return whole(fleet.robot("r3")); });
    ASSERT_TRUE(whole(fleet.robot("r3")));
    EXPECT_LE(chunk_bytes_sent(fleet), 3'080'000u) << "seed " << seed;
    all += chunk_bytes_sent(fleet);
    for (const auto& sent : fleet.sent()) {
      if (const auto* chunk = std::get_if<SubmapChunk>(&sent.outgoing.message))
        served[sent.from] += chunk->payload.size();
    }
  }
  EXPECT_LE(all, kSeeds * 3'020'000u);
  EXPECT_GT(served[agent("r1")], kSeeds * 900'000u);
  EXPECT_GT(served[agent("r2")], kSeeds * 900'000u);
}

/// A Wi-Fi that all share, and robots that each mapped alone until they met on it.
TEST(SubmapTransfer, ten_robots_on_one_channel_send_little_twice) {
  for (const double mbit : {15.0, 4.0}) {
    for (const std::size_t robots : {4u, 10u}) {
      SimFleet::Network network;
      network.max_delay = std::chrono::milliseconds(20);
      network.short_range = {mbit * 125'000.0, 100'000.0};
      std::vector<std::string> names;
      for (std::size_t k = 1; k <= robots; ++k) names.push_back("r" + std::to_string(k));
      SimFleet fleet(names, network, 3, {}, testing::no_candidates);
      bool open = false;
      link(fleet, open);
      for (const std::string& name : names) fleet.start(name);
      constexpr std::size_t kSubmap = 90'000;
      for (std::size_t k = 0; k < robots; ++k) {
        for (int n = 0; n < 6; ++n)
          fleet.add_node(names[k], 1000.0 * static_cast<double>(k) + 5.0 * n, kSubmap);
      }
      fleet.run_for(std::chrono::minutes(5), [&] { return fleet.equal_sets(6 * robots); });
      ASSERT_TRUE(fleet.equal_sets(6 * robots));
      open = true;
      const Stamp met = fleet.now();
      fleet.run_for(std::chrono::minutes(5), [&] { return fleet.all(whole); });
      ASSERT_TRUE(fleet.all(whole)) << robots << " robots, " << mbit << " Mbit/s";
      const auto needed = static_cast<double>(6 * robots * (robots - 1) * kSubmap);
      const double used = needed / (to_seconds(fleet.now() - met) * mbit * 125'000.0);
      // The worst of eight seeds had 1.13, 0.27 and 0.64 at 15 Mbit/s, 1.15, 0.10 and 0.80 at 4; with a
      // window for each peer alone ten robots lost 1.8 and 3.3 packets for each that passed.
      const double on_air = fleet.short_range_bytes() / needed;
      const double dropped =
          static_cast<double>(fleet.short_range_drops()) * 1500.0 / fleet.short_range_bytes();
      EXPECT_LT(on_air, 1.2) << robots << " robots, " << mbit << " Mbit/s; 1.07 with headers alone";
      EXPECT_LT(dropped, mbit > 10.0 ? 0.36 : 0.13) << robots << " robots, " << mbit << " Mbit/s";
      EXPECT_GT(used, mbit > 10.0 ? 0.55 : 0.7) << robots << " robots, " << mbit << " Mbit/s";
    }
  }
}

/// From the contact until r1 has all that r3 has, 2 MB, while of the chunks of r2 one in `one_in` arrives or
/// none (0).
double seconds_beside_a_peer_at_the_edge(unsigned one_in, unsigned seed) {
  SimFleet::Network network;
  network.max_delay = std::chrono::milliseconds(20);
  network.short_range = {1'875'000.0, 100'000.0};
  SimFleet fleet({"r1", "r2", "r3"}, network, seed, {}, testing::no_candidates);
  unsigned chunks = 0;
  fleet.lost = [&](const SimFleet::Sent& sent) {
    if (!std::holds_alternative<SubmapChunk>(sent.outgoing.message) || sent.from != agent("r2")) return false;
    return one_in == 0 || ++chunks % one_in != 0;
  };
  bool open = false;
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach reach) {
    return reach == Reach::kLongRange || (open && (from == agent("r1") || to == agent("r1")));
  };
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  for (int k = 0; k < 20; ++k) {
    fleet.add_node("r2", 5.0 * k, 100'000);
    fleet.add_node("r3", 1000.0 + 5.0 * k, 100'000);
  }
  fleet.run_for(std::chrono::minutes(2), [&] { return fleet.equal_sets(40); });
  EXPECT_TRUE(fleet.equal_sets(40));
  open = true;
  const Stamp met = fleet.now();
  const auto has_all_of_r3 = [&] {
    const store::Store& store = *fleet.robot("r1").store;
    for (std::uint32_t k = 0; k < 20; ++k) {
      if (!store.has_submap({agent("r3"), k})) return false;
    }
    return true;
  };
  fleet.run_for(std::chrono::minutes(2), has_all_of_r3);
  EXPECT_TRUE(has_all_of_r3());
  return to_seconds(fleet.now() - met);
}

/// r1 hears r2 as well as r3, but of r2's chunks none or one in ten comes; its submaps are the first in
/// order.
TEST(SubmapTransfer, a_peer_at_the_edge_of_reach_does_not_hold_up_the_others) {
  for (const unsigned one_in : {0u, 10u}) {
    std::array<double, 5> seconds{};
    for (unsigned seed = 0; seed < seconds.size(); ++seed)
      seconds[seed] = seconds_beside_a_peer_at_the_edge(one_in, 4 + seed);
    std::ranges::sort(seconds);
    // 2 MB over 15 Mbit/s: 1.1 s, and a digest before.
    EXPECT_LT(seconds[2], 5.3) << "one chunk of r2 in " << one_in;
    EXPECT_LT(seconds.back(), 9.0) << "one chunk of r2 in " << one_in;
  }
}

TEST(SubmapTransfer, is_passed_on_by_a_third_robot) {
  SimFleet fleet({"r1", "r2", "r3"}, {}, 5, {}, testing::no_candidates);
  const auto between = [](const AgentId& a, const AgentId& b, const char* x, const char* y) {
    return (a == agent(x) && b == agent(y)) || (a == agent(y) && b == agent(x));
  };
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach) {
    return between(from, to, "r1", "r2");
  };
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  for (int k = 0; k < 5; ++k) fleet.add_node("r1", 5.0 * k, 50'000);
  fleet.run_for(std::chrono::minutes(1), [&] { return fleet.robot("r2").store->submap_set().size() == 5; });
  ASSERT_EQ(fleet.robot("r2").store->submap_set().size(), 5u);
  fleet.kill("r1");
  fleet.reachable = [&](const AgentId& from, const AgentId& to, Reach) {
    return between(from, to, "r2", "r3");
  };
  fleet.run_for(std::chrono::minutes(2), [&] { return fleet.robot("r3").store->submap_set().size() == 5; });
  EXPECT_EQ(fleet.robot("r3").store->submap_set().size(), 5u);
  EXPECT_TRUE(fleet.robot("r3").exchange->complete());
}

}  // namespace
}  // namespace fleetmap::exchange
