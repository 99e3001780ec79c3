#include "fleetmap/exchange/encounters.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

const AgentId kA = agent("a");
const AgentId kB = agent("b");
const Stamp kStart = stamp_from_ns(1'000'000'000);

/// Search radius r_min = 20 m.
graph::Node node_at(const AgentId& agent, std::uint32_t seq, double east_m) {
  auto node = testing::make_node(agent, seq, Bytes{}, east_m);
  node.G->covariance = 0.01 * Matrix6d::Identity();
  return node;
}

EncounterConfig at_once() {
  EncounterConfig config;
  config.ripe_nodes = 0;
  return config;
}

std::vector<NodeId> wanted(const Encounters::Due& due) {
  std::vector<NodeId> nodes;
  for (const auto& [node, worth] : due.wanted) nodes.push_back(node);
  return nodes;
}

NodePair mirrored(const NodePair& pair) { return {pair.theirs, pair.ours}; }

TEST(Encounters, begin_with_the_nearest_own_node_within_the_radius_of_eq_1) {
  Encounters a(kA, at_once());
  a.on_heard(kB, kStart);
  for (std::uint32_t seq = 0; seq < 5; ++seq) a.on_node(node_at(kA, seq, 5.0 * seq), kStart);
  a.on_node(node_at(kB, 0, 41.0), kStart);  // 21 m from the nearest
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  EXPECT_TRUE(a.idle(kStart));
  a.on_node(node_at(kB, 1, 38.0), kStart);
  const auto due = a.tick(kStart);
  EXPECT_EQ(wanted(due), (std::vector<NodeId>{{kB, 1}}));
  ASSERT_EQ(due.matches.size(), 1u);
  EXPECT_EQ(due.matches[0].theirs, (NodeId{kB, 1}));
  EXPECT_EQ(due.matches[0].ours, (NodeId{kA, 4}));
  EXPECT_NEAR(due.matches[0].distance, 18.0, 0.1);
  EXPECT_DOUBLE_EQ(due.matches[0].radius, 20.0);
  EXPECT_FALSE(a.idle(kStart));
  EXPECT_EQ(a.on_cloud({kB, 1}), (std::vector<NodePair>{{{kA, 4}, {kB, 1}}}));
}

TEST(Encounters, are_the_same_on_both_ends_without_talk) {
  Encounters a(kA, at_once());
  Encounters b(kB, at_once());
  a.on_heard(kB, kStart);
  b.on_heard(kA, kStart);
  std::set<NodeId> a_wants;
  std::set<NodeId> b_wants;
  Stamp now = kStart;
  std::vector<NodePair> pairs;
  for (std::uint32_t seq = 0; seq < 60; ++seq) {
    a.on_heard(kB, now);
    b.on_heard(kA, now);
    const auto node_a = node_at(kA, seq, 2.0 * seq);
    const auto node_b = node_at(kB, seq, 120.0 - 2.0 * seq);
    for (const auto& node : {node_a, node_b}) {
      a.on_node(node, now);
      b.on_node(node, now);
    }
    for (const auto& [id, worth] : a.tick(now).wanted) {
      a_wants.insert(id);
      for (const auto& pair : a.on_cloud(id)) {
        pairs.push_back(pair);
        a.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kA, seq), now);
        // b computes the mirrored pair.
        for (const auto& [wanted, value] : b.tick(now).wanted) b_wants.insert(wanted);
        ASSERT_EQ(b.on_cloud(pair.ours), std::vector<NodePair>{mirrored(pair)});
        b.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kB, seq), now);
      }
    }
    now += std::chrono::seconds(2);
  }
  EXPECT_GE(pairs.size(), 2u);
  EXPECT_LE(pairs.size(), 10u);  // 120 m passed: no pair for every node
  EXPECT_EQ(a.stats().begun, b.stats().begun);
  EXPECT_TRUE(a.has_good_alignment(kB));
}

TEST(Encounters, of_one_place_are_not_repeated_until_the_spacing_is_left) {
  EncounterConfig config = at_once();
  config.spacing_aligned_m = 20.0;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  for (std::uint32_t seq = 0; seq < 50; ++seq) a.on_node(node_at(kA, seq, 1.0 * seq), kStart);
  std::vector<std::uint32_t> begun;
  for (std::uint32_t seq = 0; seq < 50; ++seq) {
    a.on_node(node_at(kB, seq, 1.0 * seq), kStart);
    for (const auto& [id, worth] : a.tick(kStart).wanted) {
      begun.push_back(id.seq);
      for (const auto& pair : a.on_cloud(id)) {
        a.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kA, seq, 0.3), kStart);
      }
    }
  }
  ASSERT_EQ(begun.size(), 3u);
  for (std::size_t k = 1; k < begun.size(); ++k) EXPECT_GE(begun[k] - begun[k - 1], 20u);
}

TEST(Encounters, that_were_rejected_are_tried_again_later_and_not_for_ever) {
  EncounterConfig config = at_once();
  Encounters a(kA, config);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);
  std::vector<Stamp> begun;
  for (Stamp now = kStart; now < kStart + std::chrono::minutes(10); now += std::chrono::seconds(1)) {
    a.on_heard(kB, now);
    for (const auto& [id, worth] : a.tick(now).wanted) {
      begun.push_back(now);
      for (const auto& pair : a.on_cloud(id)) a.on_rejected(pair, now);
    }
  }
  ASSERT_EQ(begun.size(), 2u);
  EXPECT_GE(begun[1] - begun[0], config.retry_after);
  EXPECT_EQ(a.stats().rejected, 2u);
  EXPECT_TRUE(a.idle(kStart + std::chrono::minutes(10)));
}

TEST(Encounters, wait_for_an_agent_that_is_not_there) {
  Encounters a(kA, at_once());
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);  // passed on by a third
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  EXPECT_TRUE(a.idle(kStart));
  const Stamp later = kStart + std::chrono::hours(1);
  a.on_heard(kB, later);
  EXPECT_EQ(a.tick(later).wanted.size(), 1u);
}

TEST(Encounters, keep_the_smaller_pair_when_the_two_ends_chose_different_ones) {
  // a never got b/1, b never got a/1.
  Encounters a(kA, at_once());
  Encounters b(kB, at_once());
  a.on_heard(kB, kStart);
  b.on_heard(kA, kStart);
  const auto a0 = node_at(kA, 0, 0.0), a1 = node_at(kA, 1, 3.0), b0 = node_at(kB, 0, 3.5),
             b1 = node_at(kB, 1, 0.5);
  for (const auto& node : {a0, a1, b0}) a.on_node(node, kStart);
  for (const auto& node : {b1, a0, b0}) b.on_node(node, kStart);
  auto from_a = a.tick(kStart);
  auto from_b = b.tick(kStart);
  ASSERT_EQ(from_a.matches.size(), 1u);
  ASSERT_EQ(from_b.matches.size(), 1u);
  ASSERT_NE(from_a.matches[0].ours, from_b.matches[0].theirs);
  a.on_node(b1, kStart);
  b.on_node(a1, kStart);
  a.on_match(from_b.matches[0], kStart);
  b.on_match(from_a.matches[0], kStart);
  // Exactly one side gave way, and both now hold the same pair.
  const auto gave_way_a = a.tick(kStart).withdrawn;
  const auto gave_way_b = b.tick(kStart).withdrawn;
  ASSERT_EQ(gave_way_a.size() + gave_way_b.size(), 1u);
  const NodePair kept = gave_way_a.empty() ? NodePair{from_a.matches[0].ours, from_a.matches[0].theirs}
                                           : NodePair{from_b.matches[0].theirs, from_b.matches[0].ours};
  EXPECT_EQ(a.on_cloud(kept.theirs), std::vector<NodePair>{kept});
  EXPECT_EQ(b.on_cloud(kept.ours), std::vector<NodePair>{mirrored(kept)});
}

TEST(Encounters, end_when_the_peer_has_aligned_the_pair) {
  for (const bool stop : {true, false}) {
    EncounterConfig config = at_once();
    config.stop_when_peer_aligned = stop;
    Encounters a(kA, config);
    a.on_heard(kB, kStart);
    a.on_node(node_at(kA, 0, 0.0), kStart);
    a.on_node(node_at(kB, 0, 1.0), kStart);
    ASSERT_EQ(a.tick(kStart).wanted.size(), 1u);
    a.on_alignment(testing::make_alignment({kA, 0}, {kB, 0}, kB, 0, 0.2), kStart);
    EXPECT_EQ(a.tick(kStart).withdrawn.size(), stop ? 1u : 0u);
    EXPECT_EQ(a.on_cloud({kB, 0}).size(), stop ? 0u : 1u);
  }
}

TEST(Encounters, take_the_nearest_pair_that_comes_up_while_they_ripen) {
  EncounterConfig config;
  config.ripe_nodes = 100;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  for (const std::uint32_t k : {0u, 1u, 2u, 3u}) {
    const Stamp now = kStart + std::chrono::seconds(k);
    a.on_node(node_at(kB, k, 12.0 - 3.0 * k), now);
    EXPECT_TRUE(a.tick(now).wanted.empty());
  }
  const auto due = a.tick(kStart + config.ripe_after);
  EXPECT_EQ(wanted(due), (std::vector<NodeId>{{kB, 3}}));  // 3 m away rather than 12
}

TEST(Encounters, wait_until_both_robots_have_gone_on) {
  EncounterConfig config;
  config.ripe_nodes = 2;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);
  for (const std::uint32_t seq : {1u, 2u}) {
    EXPECT_TRUE(a.tick(kStart).wanted.empty());
    a.on_node(node_at(kA, seq, 100.0 * seq), kStart);
    EXPECT_TRUE(a.tick(kStart).wanted.empty());
    a.on_node(node_at(kB, seq, -100.0 * seq), kStart);
  }
  EXPECT_EQ(wanted(a.tick(kStart)), (std::vector<NodeId>{{kB, 0}}));
}

TEST(Encounters, with_a_silent_robot_do_not_hold_up_those_with_others) {
  const AgentId kC = agent("c");
  EncounterConfig config = at_once();
  config.max_active = 1;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);
  EXPECT_EQ(wanted(a.tick(kStart)), (std::vector<NodeId>{{kB, 0}}));  // and b is never heard again
  a.on_heard(kC, kStart);
  a.on_node(node_at(kC, 0, 2.0), kStart);
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  const Stamp later = kStart + config.peer_timeout + std::chrono::seconds(1);
  a.on_heard(kC, later);
  EXPECT_EQ(wanted(a.tick(later)), (std::vector<NodeId>{{kC, 0}}));
}

TEST(Encounters, ignore_matches_that_make_no_sense) {
  Encounters a(kA, at_once());
  a.on_heard(kB, kStart);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 7, 1000.0), kStart);
  a.on_match({kB, kA, {kA, 0}, {kB, 9}, 1.0, 20.0}, kStart);          // of a node nobody knows
  a.on_match({kB, kA, {kA, 5}, {kB, 7}, 1.0, 20.0}, kStart);          // of a node that we never made
  a.on_match({kB, kA, {kB, 7}, {kA, 0}, 1.0, 20.0}, kStart);          // the wrong way round
  a.on_match({kB, agent("c"), {kA, 0}, {kB, 7}, 1.0, 20.0}, kStart);  // for another
  a.on_match({kB, kA, {kA, 0}, {kB, 7}, 1e9, 20.0}, kStart);          // too far
  a.on_match({kB, kA, {kA, 0}, {kB, 7}, std::nan(""), 20.0}, kStart);
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  EXPECT_TRUE(a.idle(kStart));
}

/// a and b were aligned at 0 and at 100 m; a pair at 110 m came first, one at 50 m later.
Encounters with_two_to_choose_from(EncounterConfig config) {
  config.max_active = 1;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  std::vector<graph::Node> of_b;
  for (std::uint32_t seq = 0; seq < 28; ++seq) {
    graph::Node ours = node_at(kA, seq, 4.0 * seq), theirs = node_at(kB, seq, 4.0 * seq);
    ours.odom_covariance = theirs.odom_covariance = 1e-5 * Matrix6d::Identity();
    a.on_node(ours, kStart);
    of_b.push_back(theirs);
  }
  for (const std::uint32_t seq : {0u, 25u}) {
    a.on_node(of_b[seq], kStart);
    auto alignment = testing::make_alignment({kA, seq}, {kB, seq}, kA, seq, 0.1);
    alignment.modes.front().covariance = 1e-5 * Matrix6d::Identity();
    a.on_alignment(alignment, kStart);
  }
  a.on_node(of_b[27], kStart);
  a.on_node(of_b[12], kStart + std::chrono::milliseconds(1));
  return a;
}

TEST(Encounters, ask_first_for_what_would_teach_the_graph_most) {
  EncounterConfig config = at_once();
  config.spacing_aligned_m = config.spacing_m = 3.0;
  const Stamp later = kStart + std::chrono::seconds(1);
  Encounters by_worth = with_two_to_choose_from(config);
  const auto due = by_worth.tick(later);
  EXPECT_EQ(wanted(due), (std::vector<NodeId>{{kB, 12}})) << "half way between two alignments";
  EXPECT_GT(due.wanted.front().worth, 0.0);
  config.order = EncounterOrder::kFirstCome;
  EXPECT_EQ(wanted(with_two_to_choose_from(config).tick(later)), (std::vector<NodeId>{{kB, 27}}));
}

TEST(Encounters, let_go_what_is_known_as_well_already) {
  EncounterConfig config = at_once();
  config.spacing_aligned_m = config.spacing_m = 3.0;
  const Stamp later = kStart + std::chrono::seconds(1);
  config.min_worth = 1.1 * with_two_to_choose_from(config).tick(later).wanted.front().worth;
  Encounters a = with_two_to_choose_from(config);
  EXPECT_TRUE(a.tick(later).wanted.empty());
  EXPECT_EQ(a.stats().worthless, 2u);
  EXPECT_TRUE(a.idle(later));
  Encounters while_there_is_room = with_two_to_choose_from(config);
  EXPECT_EQ(wanted(while_there_is_room.tick(later, true)), (std::vector<NodeId>{{kB, 12}}));
  EXPECT_EQ(while_there_is_room.stats().worthless, 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
