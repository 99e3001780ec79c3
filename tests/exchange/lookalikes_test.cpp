#include "fleetmap/exchange/lookalikes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fleetmap/exchange/encounters.hpp"
#include "store/items.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;
using testing::node_at_walls;

const AgentId kA = agent("a");
const AgentId kB = agent("b");
const Stamp kStart = stamp_from_ns(1'000'000'000);

Lookalikes::Side side_of(const graph::Node& node) {
  return node.id.agent == kA ? Lookalikes::Side::kOurs : Lookalikes::Side::kTheirs;
}

Pose pose(double x, double y, double yaw) { return make_pose(rotation_from_rpy(0, 0, yaw), {x, y, 0.0}); }

const Pose kOdomA = pose(30.0, 70.0, 1.0);
const Pose kOdomB = pose(-300.0, 20.0, -2.0);

/// a drives east along y = 0, b comes towards it 3 m beside, then leaves to the north.
graph::Node of_a(std::uint32_t seq) {
  return node_at_walls(kA, seq, kOdomA, pose(-60.0 + 10.0 * seq, 0.0, 0.0));
}
graph::Node of_b(std::uint32_t seq) {
  return node_at_walls(kB, seq, kOdomB, pose(60.0 - 10.0 * seq, 3.0, 3.1));
}

TEST(Lookalikes, places_of_two_agents_without_gps_are_found_and_near_each_other) {
  Lookalikes lookalikes({});
  std::size_t found = 0;
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    for (const auto& node : {of_a(seq), of_b(seq)}) {
      for (const Lookalikes::Pair& pair : lookalikes.add(node, false, side_of(node))) {
        const auto& [ours, theirs] = pair.fresh.agent == kA ? std::pair(pair.fresh.seq, pair.other.seq)
                                                            : std::pair(pair.other.seq, pair.fresh.seq);
        EXPECT_LE(std::abs(-60.0 + 10.0 * ours - (60.0 - 10.0 * theirs)), 10.0);
        ++found;
      }
    }
  }
  EXPECT_GE(found, 6u);
}

TEST(Lookalikes, places_that_gps_tells_apart_are_not_compared) {
  Lookalikes lookalikes({});
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    EXPECT_TRUE(lookalikes.add(of_a(seq), true, Lookalikes::Side::kOurs).empty());
    EXPECT_TRUE(lookalikes.add(of_b(seq), true, Lookalikes::Side::kTheirs).empty());
  }
  // One of the two without is enough.
  std::size_t found = 0;
  for (std::uint32_t seq = 12; seq-- > 0;) {
    auto node = of_b(seq);
    node.id.seq = 100 - seq;
    node.session = 7;
    found += lookalikes.add(node, false, side_of(node)).size();
  }
  EXPECT_GE(found, 3u);
}

TEST(Lookalikes, nodes_without_or_with_broken_descriptors_are_left_out) {
  Lookalikes lookalikes({});
  lookalikes.add(of_a(0), false, Lookalikes::Side::kOurs);
  auto node = node_at_walls(kB, 0, kOdomB, pose(-60.0, 0.0, 0.0));
  node.descriptor.clear();
  EXPECT_TRUE(lookalikes.add(node, false, side_of(node)).empty());
  node.descriptor = Bytes(17, 0xff);
  EXPECT_TRUE(lookalikes.add(node, false, side_of(node)).empty());
}

TEST(Lookalikes, configuration_that_breaks_a_rule_is_named) {
  LookalikeConfig config;
  EXPECT_TRUE(config.validate());
  config.min_similarity = 1.5;
  EXPECT_FALSE(config.validate());
  config = {};
  config.agree_m = 0.0;
  EXPECT_FALSE(config.validate());
  config = {};
  config.max_compared = 0;
  EXPECT_FALSE(config.validate());
}

TEST(Encounters, without_gps_begin_at_places_that_look_alike_and_keep_their_spacing) {
  EncounterConfig config;
  config.ripe_nodes = 0;
  config.ripe_after = Duration::zero();
  config.max_active = 100;
  Encounters a(kA, config);
  a.on_heard(kB, kStart);
  std::vector<NodePair> pairs;
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    a.on_node(of_a(seq), kStart);
    a.on_node(of_b(seq), kStart);
    for (const auto& [id, worth] : a.tick(kStart).wanted) {
      for (const NodePair& pair : a.on_cloud(id)) {
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
  EXPECT_GT(a.stats().alike, 0u);
  EXPECT_EQ(a.stats().found, 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
