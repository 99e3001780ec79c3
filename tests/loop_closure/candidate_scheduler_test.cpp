#include "fleetmap/loop_closure/candidate_scheduler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "loop_closure/located_nodes.hpp"
#include "loop_closure/received_pairs.hpp"
#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::agent;
using testing::node_at_walls;

CandidateConfig at_once() {
  CandidateConfig config;
  config.min_nodes_after = 0;
  return config;
}

std::vector<NodeId> wanted(const exchange::CloudDemand& due) {
  std::vector<NodeId> nodes;
  for (const auto& [node, information] : due.wanted) nodes.push_back(node);
  return nodes;
}

NodePair mirrored(const NodePair& pair) { return {pair.theirs, pair.ours}; }

TEST(CandidateScheduler, begin_with_the_nearest_own_node_within_the_radius_of_eq_1) {
  CandidateScheduler a(kA, at_once());
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
  EXPECT_EQ(on_cloud(a, {kB, 1}), (std::vector<NodePair>{{{kA, 4}, {kB, 1}}}));
}

TEST(CandidateScheduler, are_the_same_on_both_ends_without_talk) {
  CandidateScheduler a(kA, at_once());
  CandidateScheduler b(kB, at_once());
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
    for (const auto& [id, information] : a.tick(now).wanted) {
      a_wants.insert(id);
      for (const auto& pair : on_cloud(a, id)) {
        pairs.push_back(pair);
        a.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kA, seq), now);
        // b computes the mirrored pair.
        for (const auto& [wanted, value] : b.tick(now).wanted) b_wants.insert(wanted);
        ASSERT_EQ(on_cloud(b, pair.ours), std::vector<NodePair>{mirrored(pair)});
        b.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kB, seq), now);
      }
    }
    now += std::chrono::seconds(2);
  }
  EXPECT_GE(pairs.size(), 2u);
  EXPECT_LE(pairs.size(), 10u);  // 120 m passed: no pair for every node
  EXPECT_EQ(a.stats().requested, b.stats().requested);
  EXPECT_TRUE(a.has_good_alignment(kB));
}

TEST(CandidateScheduler, candidates_of_one_place_are_not_repeated_within_the_spacing) {
  CandidateConfig config = at_once();
  config.spacing_aligned_m = 20.0;
  CandidateScheduler a(kA, config);
  a.on_heard(kB, kStart);
  for (std::uint32_t seq = 0; seq < 50; ++seq) a.on_node(node_at(kA, seq, 1.0 * seq), kStart);
  std::vector<std::uint32_t> begun;
  for (std::uint32_t seq = 0; seq < 50; ++seq) {
    a.on_node(node_at(kB, seq, 1.0 * seq), kStart);
    for (const auto& [id, information] : a.tick(kStart).wanted) {
      begun.push_back(id.seq);
      for (const auto& pair : on_cloud(a, id)) {
        a.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kA, seq, 0.3), kStart);
      }
    }
  }
  ASSERT_EQ(begun.size(), 3u);
  for (std::size_t k = 1; k < begun.size(); ++k) EXPECT_GE(begun[k] - begun[k - 1], 20u);
}

TEST(CandidateScheduler, that_were_rejected_are_tried_again_later_and_not_for_ever) {
  CandidateConfig config = at_once();
  CandidateScheduler a(kA, config);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);
  std::vector<Stamp> begun;
  for (Stamp now = kStart; now < kStart + std::chrono::minutes(10); now += std::chrono::seconds(1)) {
    a.on_heard(kB, now);
    for (const auto& [id, information] : a.tick(now).wanted) {
      begun.push_back(now);
      for (const auto& pair : on_cloud(a, id)) a.on_rejected(pair, now);
    }
  }
  ASSERT_EQ(begun.size(), 2u);
  EXPECT_GE(begun[1] - begun[0], config.retry_after);
  EXPECT_EQ(a.stats().rejected, 2u);
  EXPECT_TRUE(a.idle(kStart + std::chrono::minutes(10)));
}

TEST(CandidateScheduler, wait_for_an_agent_that_is_not_there) {
  CandidateScheduler a(kA, at_once());
  a.on_node(node_at(kA, 0, 0.0), kStart);
  a.on_node(node_at(kB, 0, 1.0), kStart);  // passed on by a third
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  EXPECT_TRUE(a.idle(kStart));
  const Stamp later = kStart + std::chrono::hours(1);
  a.on_heard(kB, later);
  EXPECT_EQ(a.tick(later).wanted.size(), 1u);
}

TEST(CandidateScheduler, keep_the_smaller_pair_when_the_two_ends_chose_different_ones) {
  // a never got b/1, b never got a/1.
  CandidateScheduler a(kA, at_once());
  CandidateScheduler b(kB, at_once());
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
  EXPECT_EQ(on_cloud(a, kept.theirs), std::vector<NodePair>{kept});
  EXPECT_EQ(on_cloud(b, kept.ours), std::vector<NodePair>{mirrored(kept)});
}

TEST(CandidateScheduler, end_when_the_peer_has_aligned_the_pair) {
  for (const bool stop : {true, false}) {
    CandidateConfig config = at_once();
    config.stop_when_peer_aligned = stop;
    CandidateScheduler a(kA, config);
    a.on_heard(kB, kStart);
    a.on_node(node_at(kA, 0, 0.0), kStart);
    a.on_node(node_at(kB, 0, 1.0), kStart);
    ASSERT_EQ(a.tick(kStart).wanted.size(), 1u);
    a.on_alignment(testing::make_alignment({kA, 0}, {kB, 0}, kB, 0, 0.2), kStart);
    EXPECT_EQ(a.tick(kStart).withdrawn.size(), stop ? 1u : 0u);
    EXPECT_EQ(on_cloud(a, {kB, 0}).size(), stop ? 0u : 1u);
  }
}

TEST(CandidateScheduler, take_the_nearest_pair_that_is_found_while_they_wait) {
  CandidateConfig config;
  config.min_nodes_after = 100;
  CandidateScheduler a(kA, config);
  a.on_heard(kB, kStart);
  a.on_node(node_at(kA, 0, 0.0), kStart);
  for (const std::uint32_t k : {0u, 1u, 2u, 3u}) {
    const Stamp now = kStart + std::chrono::seconds(k);
    a.on_node(node_at(kB, k, 12.0 - 3.0 * k), now);
    EXPECT_TRUE(a.tick(now).wanted.empty());
  }
  const auto due = a.tick(kStart + config.max_wait);
  EXPECT_EQ(wanted(due), (std::vector<NodeId>{{kB, 3}}));  // 3 m away rather than 12
}

TEST(CandidateScheduler, wait_until_both_robots_have_gone_on) {
  CandidateConfig config;
  config.min_nodes_after = 2;
  CandidateScheduler a(kA, config);
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

TEST(CandidateScheduler, with_a_silent_robot_do_not_hold_up_those_with_others) {
  const AgentId kC = agent("c");
  CandidateConfig config = at_once();
  config.max_active = 1;
  CandidateScheduler a(kA, config);
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

TEST(CandidateScheduler, ignore_matches_that_make_no_sense) {
  CandidateScheduler a(kA, at_once());
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

/// a drives east along y = 0, b comes towards it 3 m beside; without G.
graph::Node beside_walls(const AgentId& agent, std::uint32_t seq) {
  const auto pose = [](double x, double y, double yaw) {
    return make_pose(rotation_from_rpy(0, 0, yaw), {x, y, 0.0});
  };
  return agent == kA ? node_at_walls(kA, seq, pose(30.0, 70.0, 1.0), pose(-60.0 + 10.0 * seq, 0.0, 0.0))
                     : node_at_walls(kB, seq, pose(-300.0, 20.0, -2.0), pose(60.0 - 10.0 * seq, 3.0, 3.1));
}

TEST(CandidateScheduler, without_gps_begin_at_places_that_look_alike_and_keep_their_spacing) {
  CandidateConfig config;
  config.min_nodes_after = 0;
  config.max_wait = Duration::zero();
  config.max_active = 100;
  CandidateScheduler a(kA, config);
  a.on_heard(kB, kStart);
  std::vector<NodePair> pairs;
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    a.on_node(beside_walls(kA, seq), kStart);
    a.on_node(beside_walls(kB, seq), kStart);
    for (const auto& [id, information] : a.tick(kStart).wanted) {
      for (const NodePair& pair : on_cloud(a, id)) {
        pairs.push_back(pair);
        a.on_alignment(testing::make_alignment(pair.ours, pair.theirs, kA, seq, 0.1), kStart);
      }
    }
  }
  ASSERT_GE(pairs.size(), 2u);
  EXPECT_LE(pairs.size(), 6u);  // 120 m, 20 m apart once aligned
  for (const NodePair& pair : pairs)
    EXPECT_LE(std::abs(-120.0 + 10.0 * pair.ours.seq + 10.0 * pair.theirs.seq), 10.0);
  EXPECT_TRUE(a.has_good_alignment(kB));
  EXPECT_GT(a.stats().by_descriptor, 0u);
  EXPECT_EQ(a.stats().by_position, 0u);
}

/// a and b were aligned at 0 and at 100 m; a pair at 110 m came first, one at 50 m later.
std::unique_ptr<CandidateScheduler> with_two_to_choose_from(CandidateConfig config) {
  config.max_active = 1;
  auto scheduler = std::make_unique<CandidateScheduler>(kA, config);
  CandidateScheduler& a = *scheduler;
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
  return scheduler;
}

TEST(CandidateScheduler, ask_first_for_what_would_teach_the_graph_most) {
  CandidateConfig config = at_once();
  config.spacing_aligned_m = config.spacing_m = 3.0;
  const Stamp later = kStart + std::chrono::seconds(1);
  const auto by_information = with_two_to_choose_from(config);
  const auto due = by_information->tick(later);
  EXPECT_EQ(wanted(due), (std::vector<NodeId>{{kB, 12}})) << "half way between two alignments";
  EXPECT_GT(due.wanted.front().information, 0.0);
  config.order = exchange::CloudOrder::kFirstCome;
  EXPECT_EQ(wanted(with_two_to_choose_from(config)->tick(later)), (std::vector<NodeId>{{kB, 27}}));
}

TEST(CandidateScheduler, let_go_what_is_known_as_well_already) {
  CandidateConfig config = at_once();
  config.spacing_aligned_m = config.spacing_m = 3.0;
  const Stamp later = kStart + std::chrono::seconds(1);
  config.min_information = 1.1 * with_two_to_choose_from(config)->tick(later).wanted.front().information;
  const auto a = with_two_to_choose_from(config);
  EXPECT_TRUE(a->tick(later).wanted.empty());
  EXPECT_EQ(a->stats().uninformative, 2u);
  EXPECT_TRUE(a->idle(later));
  const auto while_there_is_room = with_two_to_choose_from(config);
  EXPECT_EQ(wanted(while_there_is_room->tick(later, true)), (std::vector<NodeId>{{kB, 12}}));
  EXPECT_EQ(while_there_is_room->stats().uninformative, 0u);
}

}  // namespace
}  // namespace fleetmap::loop_closure
