#include "fleetmap/loop_closure/peer_candidates.hpp"

#include <gtest/gtest.h>

#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "loop_closure/located_nodes.hpp"
#include "loop_closure/received_pairs.hpp"
#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

TEST(PeerCandidates, are_counted_by_what_became_of_them) {
  CandidateConfig config;
  config.min_nodes_after = 0;
  config.max_active = 1;
  CandidateScheduler a(kA, config);
  EXPECT_TRUE(a.by_peer(kStart).empty());
  for (std::uint32_t seq = 0; seq < 4; ++seq) {
    a.on_node(node_at(kA, seq, 100.0 * seq), kStart);
    a.on_node(node_at(kB, seq, 100.0 * seq + 1.0), kStart);
  }
  const auto now = [&a](Stamp at) { return a.by_peer(at).at(kB); };
  EXPECT_EQ(now(kStart).waiting, 4u);
  EXPECT_FALSE(now(kStart).heard);
  a.on_heard(kB, kStart);
  EXPECT_TRUE(now(kStart).heard);
  const auto request = [&a] { return a.tick(kStart).wanted.at(0).node; };
  a.on_cloud_lost(request(), kStart);
  EXPECT_EQ(now(kStart).not_received, 1u);
  for (const NodePair& pair : on_cloud(a, request())) a.on_rejected(pair, kStart);
  const NodeId third = request();
  EXPECT_EQ(now(kStart).requested, 1u);
  const auto pairs = on_cloud(a, third);
  EXPECT_EQ(now(kStart).registering, 1u);
  a.on_alignment(testing::make_alignment(pairs[0].ours, pairs[0].theirs, kA, 0), kStart);
  const auto end = now(kStart);
  EXPECT_EQ(end.waiting, 1u);
  EXPECT_EQ(end.rejected, 1u);
  EXPECT_EQ(end.not_received, 1u);
  EXPECT_EQ(end.to_be_retried, 2u);
  EXPECT_EQ(end.aligned, 1u);
  EXPECT_EQ(end.requested + end.registering, 0u);
}

}  // namespace
}  // namespace fleetmap::loop_closure
