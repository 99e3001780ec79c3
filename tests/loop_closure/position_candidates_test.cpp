#include "position_candidates.hpp"

#include <gtest/gtest.h>

#include "loop_closure/located_nodes.hpp"
#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::agent;

TEST(PositionCandidates, AnOwnNodeIsPairedWithTheNearestOfEachPeer) {
  PositionCandidates candidates(agent("a"), {});
  for (const char* peer : {"b", "c"}) {
    EXPECT_TRUE(candidates.propose(node_at(agent(peer), 0, 0.0)).empty());
    EXPECT_TRUE(candidates.propose(node_at(agent(peer), 1, 5.0)).empty());
  }
  EXPECT_TRUE(candidates.propose(node_at(agent("d"), 0, 100.0)).empty());
  const auto found = candidates.propose(node_at(agent("a"), 0, 8.0));
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found[k].target, (NodeId{agent("a"), 0}));
    EXPECT_EQ(found[k].source, (NodeId{agent(k == 0 ? "b" : "c"), 1}));
    EXPECT_NEAR(found[k].distance, 3.0, 0.01);
    EXPECT_DOUBLE_EQ(found[k].radius, 20.0);
  }
}

TEST(PositionCandidates, APeersNodeIsPairedWithOursAlone) {
  PositionCandidates candidates(agent("a"), {});
  candidates.propose(node_at(agent("c"), 0, 0.0));
  candidates.propose(node_at(agent("a"), 3, 4.0));
  const auto found = candidates.propose(node_at(agent("b"), 7, 1.0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].pair(), (NodePair{{agent("a"), 3}, {agent("b"), 7}}));
}

}  // namespace
}  // namespace fleetmap::loop_closure
