#include "descriptor_candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::node_at_walls;

DescriptorCandidates::Side side_of(const graph::Node& node) {
  return node.id.agent == kA ? DescriptorCandidates::Side::kOurs : DescriptorCandidates::Side::kTheirs;
}

const Pose kOdomA = pose(30.0, 70.0, 1.0);
const Pose kOdomB = pose(-300.0, 20.0, -2.0);

/// a drives east along y = 0, b comes towards it 3 m beside, then leaves to the north.
graph::Node of_a(std::uint32_t seq) {
  return node_at_walls(kA, seq, kOdomA, pose(-60.0 + 10.0 * seq, 0.0, 0.0));
}
graph::Node of_b(std::uint32_t seq) {
  return node_at_walls(kB, seq, kOdomB, pose(60.0 - 10.0 * seq, 3.0, 3.1));
}

TEST(DescriptorCandidates, places_of_two_agents_without_gps_are_found_and_near_each_other) {
  DescriptorCandidates candidates({}, 30.0);
  std::size_t found = 0;
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    for (const auto& node : {of_a(seq), of_b(seq)}) {
      for (const LoopCandidate& candidate : candidates.propose(node, false, side_of(node))) {
        EXPECT_EQ(candidate.origin, LoopCandidate::Origin::kDescriptor);
        EXPECT_EQ(candidate.target.agent, kA);
        EXPECT_LE(std::abs(-60.0 + 10.0 * candidate.target.seq - (60.0 - 10.0 * candidate.source.seq)), 10.0);
        ++found;
      }
    }
  }
  EXPECT_GE(found, 6u);
}

TEST(DescriptorCandidates, places_that_gps_tells_apart_are_not_compared) {
  DescriptorCandidates candidates({}, 30.0);
  for (std::uint32_t seq = 0; seq < 12; ++seq) {
    EXPECT_TRUE(candidates.propose(of_a(seq), true, DescriptorCandidates::Side::kOurs).empty());
    EXPECT_TRUE(candidates.propose(of_b(seq), true, DescriptorCandidates::Side::kTheirs).empty());
  }
  // One of the two without is enough.
  std::size_t found = 0;
  for (std::uint32_t seq = 12; seq-- > 0;) {
    auto node = of_b(seq);
    node.id.seq = 100 - seq;
    node.session = 7;
    found += candidates.propose(node, false, side_of(node)).size();
  }
  EXPECT_GE(found, 3u);
}

TEST(DescriptorCandidates, nodes_without_or_with_broken_descriptors_are_left_out) {
  DescriptorCandidates candidates({}, 30.0);
  candidates.propose(of_a(0), false, DescriptorCandidates::Side::kOurs);
  auto node = node_at_walls(kB, 0, kOdomB, pose(-60.0, 0.0, 0.0));
  node.descriptor.clear();
  EXPECT_TRUE(candidates.propose(node, false, side_of(node)).empty());
  node.descriptor = Bytes(17, 0xff);
  EXPECT_TRUE(candidates.propose(node, false, side_of(node)).empty());
}

TEST(DescriptorCandidates, configuration_that_breaks_a_rule_is_named) {
  DescriptorMatchConfig config;
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

}  // namespace
}  // namespace fleetmap::loop_closure
