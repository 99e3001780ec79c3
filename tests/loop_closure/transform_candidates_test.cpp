// CandidateScheduler without GPS, once alignments tie the odometry frames of two robots.
#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "loop_closure/received_pairs.hpp"
#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::node_at_walls;

/// a drives east from 0 along y = 0, b beside it at y = 5 m; a node every 5 m. Odometry frames lie anywhere.
Pose T_site_node(const NodeId& id) { return pose(5.0 * id.seq, id.agent == kA ? 0.0 : 5.0, 0.3); }
Pose T_site_odom(const AgentId& agent) {
  return agent == kA ? pose(30.0, 70.0, 1.0) : pose(-300.0, 20.0, -2.0);
}
/// Without G, and with nothing around to be known again by.
graph::Node node(const AgentId& agent, std::uint32_t seq) {
  graph::Node node = testing::make_node(agent, seq, Bytes{});
  node.G.reset();
  node.descriptor.clear();
  node.T_odom_base = T_site_odom(agent).inverse() * T_site_node(node.id);
  node.odom_covariance = 1e-5 * Matrix6d::Identity();
  return node;
}
graph::Alignment alignment(const NodeId& i, const NodeId& j, const Pose& T_i_j) {
  graph::Alignment alignment = testing::make_alignment(i, j, kA, i.seq);
  alignment.modes.front().T_i_j = T_i_j;
  return alignment;
}
std::vector<graph::Alignment> ties(std::uint32_t first, const Pose& T_site_other = Pose::Identity()) {
  std::vector<graph::Alignment> used;
  for (std::uint32_t seq = first; seq < first + 3; ++seq) {
    used.push_back(alignment({kA, seq}, {kB, seq},
                             T_site_node({kA, seq}).inverse() * T_site_other * T_site_node({kB, seq})));
  }
  return used;
}

CandidateConfig all_at_once() {
  CandidateConfig config;
  config.min_nodes_after = 0;
  config.max_wait = Duration::zero();
  config.max_active = 100;
  return config;
}

/// The clouds requested once everything searchable has been searched.
std::vector<NodeId> wanted_in_time(CandidateScheduler& a) {
  std::vector<NodeId> all;
  for (int tick = 0; tick < 20; ++tick) {
    for (const auto& [id, information] : a.tick(kStart).wanted) all.push_back(id);
  }
  return all;
}

void add_nodes(CandidateScheduler& a, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t seq = first; seq < end; ++seq) {
    a.on_node(node(kA, seq), kStart);
    a.on_node(node(kB, seq), kStart);
  }
}

TEST(TransformCandidates, AreFoundByWhereTheFramesLieAlsoAtPlacesOfBefore) {
  CandidateScheduler a(kA, all_at_once());
  a.on_heard(kB, kStart);
  add_nodes(a, 0, 12);
  EXPECT_TRUE(a.tick(kStart).wanted.empty());
  EXPECT_FALSE(a.transform({{kA, 1}, {kB, 1}}));
  a.on_used_alignments(ties(0));
  EXPECT_FALSE(a.idle(kStart)) << "all places of before are to be searched";
  const auto before = wanted_in_time(a);
  EXPECT_GE(before.size(), 4u);  // 60 m, 10 m apart
  for (const NodeId& id : before) {
    const auto pairs = on_cloud(a, id);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].ours.seq, pairs[0].theirs.seq);
    const auto T = a.transform(pairs[0]);
    ASSERT_TRUE(T);
    const Pose truth = T_site_node(pairs[0].ours).inverse() * T_site_node(pairs[0].theirs);
    EXPECT_LT(se3_log(truth.inverse() * T->T_a_b).norm(), 1e-9);
  }
  add_nodes(a, 12, 20);
  const auto after = wanted_in_time(a);
  EXPECT_GE(after.size(), 2u);
  for (const NodeId& id : after) EXPECT_GE(id.seq, 12u);
  EXPECT_EQ(a.stats().by_descriptor, 0u);
  EXPECT_EQ(a.stats().by_position, 0u);
  EXPECT_GE(a.stats().by_transform, 6u);
  // Nothing new: the same ties again begin nothing.
  a.on_used_alignments(ties(0));
  EXPECT_TRUE(wanted_in_time(a).empty());
}

TEST(TransformCandidates, BothEndsChooseTheSamePairs) {
  CandidateScheduler a(kA, all_at_once());
  CandidateScheduler b(kB, all_at_once());
  a.on_heard(kB, kStart);
  b.on_heard(kA, kStart);
  std::set<NodePair> of_a, of_b;  // as a sees them
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    for (CandidateScheduler* end : {&a, &b}) {
      if (seq == (end == &a ? 4u : 6u)) end->on_used_alignments(ties(0));
      end->on_node(node(kA, seq), kStart);
      end->on_node(node(kB, seq), kStart);
    }
    // Each hears what the other asks for.
    const auto from_a = a.tick(kStart), from_b = b.tick(kStart);
    for (const auto& match : from_a.matches) b.on_match(match, kStart);
    for (const auto& match : from_b.matches) a.on_match(match, kStart);
  }
  for (int tick = 0; tick < 10; ++tick) {
    const auto from_a = a.tick(kStart), from_b = b.tick(kStart);
    for (const auto& match : from_a.matches) b.on_match(match, kStart);
    for (const auto& match : from_b.matches) a.on_match(match, kStart);
  }
  for (std::uint32_t seq = 0; seq < 20; ++seq) {
    for (const NodePair& pair : on_cloud(a, {kB, seq})) of_a.insert(pair);
    for (const NodePair& pair : on_cloud(b, {kA, seq})) of_b.insert({pair.theirs, pair.ours});
  }
  EXPECT_GE(of_a.size(), 5u);
  EXPECT_EQ(of_a, of_b);
}

TEST(TransformCandidates, UsesGWhereBothNodesHaveIt) {
  CandidateScheduler a(kA, all_at_once());
  a.on_heard(kB, kStart);
  for (std::uint32_t seq = 0; seq < 4; ++seq) {
    for (const AgentId& agent : {kA, kB}) {
      graph::Node located = node(agent, seq);
      located.G = testing::make_node(agent, seq, Bytes{}, 5.0 * seq).G;
      located.G->covariance = 0.01 * Matrix6d::Identity();
      a.on_node(located, kStart);
    }
  }
  a.on_used_alignments(ties(0));
  EXPECT_FALSE(a.transform({{kA, 1}, {kB, 1}}));
  EXPECT_EQ(a.stats().by_transform, 0u);
  EXPECT_GT(a.stats().by_position, 0u);
  // One of the two without is enough.
  a.on_node(node(kA, 4), kStart);
  EXPECT_TRUE(a.transform({{kA, 4}, {kB, 3}}));
  EXPECT_EQ(a.stats().by_transform, 1u);
}

TEST(TransformCandidates, TransformsThatFailAgainAndAgainAreDistrustedUntilOneIsRight) {
  CandidateConfig config = all_at_once();
  CandidateScheduler a(kA, config);
  a.on_heard(kB, kStart);
  add_nodes(a, 0, 60);
  a.on_used_alignments(ties(0));
  std::size_t rejected = 0;
  NodePair last;
  const auto begun = wanted_in_time(a);
  for (const NodeId& id : begun) {
    for (const NodePair& pair : on_cloud(a, id)) {
      EXPECT_EQ(a.transform(pair).has_value(), rejected < 5);
      ++rejected;
      a.on_rejected(pair, kStart);
      last = pair;
    }
  }
  ASSERT_GE(rejected, 6u);
  add_nodes(a, 60, 70);
  a.on_used_alignments(ties(0));
  EXPECT_TRUE(wanted_in_time(a).empty());
  // One that was found otherwise and accepted: what was made in the meantime is searched.
  a.on_alignment(testing::make_alignment(last.ours, last.theirs, kA, 0), kStart);
  EXPECT_TRUE(a.transform(last));
  a.on_used_alignments(ties(0));
  const auto again = wanted_in_time(a);
  EXPECT_TRUE(std::ranges::any_of(again, [](const NodeId& id) { return id.seq >= 62; }));
}

TEST(TransformCandidates, OtherTiesThanBeforeAreBelievedAnew) {
  CandidateScheduler a(kA, all_at_once());
  a.on_heard(kB, kStart);
  add_nodes(a, 0, 60);
  // As if b were 40 m farther: what is paired is not what is abreast.
  a.on_used_alignments(ties(0, pose(40.0, 0.0, 0.0)));
  for (const NodeId& id : wanted_in_time(a)) {
    for (const NodePair& pair : on_cloud(a, id)) {
      EXPECT_NE(pair.ours.seq, pair.theirs.seq);
      a.on_rejected(pair, kStart);
    }
  }
  EXPECT_FALSE(a.transform({{kA, 50}, {kB, 50}})) << "distrusted by now";
  a.on_used_alignments(ties(0));
  std::size_t abreast = 0;
  for (const NodeId& id : wanted_in_time(a)) {
    for (const NodePair& pair : on_cloud(a, id)) abreast += pair.ours.seq == pair.theirs.seq;
  }
  EXPECT_GE(abreast, 5u);
}

TEST(TransformCandidates, BehindAGapAreFoundWhenTheMissingNodeComes) {
  CandidateScheduler a(kA, all_at_once());
  a.on_heard(kB, kStart);
  add_nodes(a, 0, 3);
  a.on_used_alignments(ties(0));
  EXPECT_FALSE(wanted_in_time(a).empty());
  for (std::uint32_t seq = 3; seq < 40; ++seq) {
    a.on_node(node(kA, seq), kStart);
    if (seq != 12) a.on_node(node(kB, seq), kStart);
  }
  const auto beyond = [](const NodeId& id) { return id.seq > 12; };
  EXPECT_TRUE(std::ranges::none_of(wanted_in_time(a), beyond));
  a.on_node(node(kB, 12), kStart);
  EXPECT_TRUE(std::ranges::any_of(wanted_in_time(a), beyond));
}

TEST(TransformCandidates, DescriptorMatchesElsewhereAreNotTried) {
  CandidateConfig config = all_at_once();
  config.min_nodes_after = 1000;
  config.max_wait = std::chrono::hours(1);
  CandidateScheduler a(kA, config);
  a.on_heard(kB, kStart);
  const auto add = [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t seq = first; seq < end; ++seq) {
      for (const AgentId& agent : {kA, kB})
        a.on_node(node_at_walls(agent, seq, T_site_odom(agent), pose(-60.0 + 10.0 * seq, 0.0, 0.0)), kStart);
    }
  };
  add(0, 8);
  ASSERT_GT(a.stats().by_descriptor, 0u);
  ASSERT_FALSE(a.idle(kStart));
  // The two looked the same, but they are half a kilometre apart.
  std::vector<graph::Alignment> apart;
  for (std::uint32_t seq = 0; seq < 3; ++seq)
    apart.push_back(alignment({kA, seq}, {kB, seq}, pose(500.0, 0.0, 0.0)));
  a.on_used_alignments(apart);
  EXPECT_TRUE(wanted_in_time(a).empty());
  EXPECT_TRUE(a.idle(kStart));
  const auto alike = a.stats().by_descriptor;
  add(8, 14);
  EXPECT_GT(a.stats().by_descriptor, alike);
  EXPECT_TRUE(a.idle(kStart));
}

}  // namespace
}  // namespace fleetmap::loop_closure
