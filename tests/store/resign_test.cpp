#include <gtest/gtest.h>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::TemporaryFolder;

TEST(Resign, drops_what_is_not_signed_and_gives_a_contested_name_to_the_signed_content) {
  const TemporaryFolder folder;
  const auto path = folder / "store.db";
  const Bytes submap = random_bytes(700, 1);
  const auto node = [&](const AgentId& maker, std::uint32_t seq, double east) {
    return make_node(maker, seq, submap, east);
  };
  const auto is_east = [](const graph::Node& n, double east) {
    return make_node(n.id.agent, n.id.seq, Bytes{}, east).G->position == n.G->position;
  };
  {
    auto store = Store::open(path, kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(node(kSelf, 0, 0.0), submap).value(), Put::kAdded);
    for (const std::uint32_t seq : {0u, 1u, 2u, 3u}) {
      ASSERT_EQ(store.put_node(node(kPeer, seq, 0.0)).value(), Put::kAdded);
      ASSERT_EQ(store.put_submap({kPeer, seq}, submap).value(), Put::kAdded);
    }
    for (const std::uint32_t seq : {1u, 2u, 3u})
      ASSERT_EQ(store.put_node(node(kPeer, seq, 50.0)).value(), Put::kConflict);
    ASSERT_EQ(store.put_node_with_submap(node(kSelf, 1, 0.0), submap).value(), Put::kAdded);
    ASSERT_EQ(store.put_node(node(kSelf, 1, 50.0)).value(), Put::kConflict);
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 0}, kPeer, 2)).value(), Put::kAdded);
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 0}, kSelf, 2)).value(), Put::kAdded);
    const auto done = store.resign(
        [&](const graph::Node& n) -> std::optional<Signature> {
          const bool first = is_east(n, 0.0);
          const bool kept = n.id.agent == kSelf ? first : (n.id.seq == 1 && !first) || n.id.seq == 2;
          return kept ? std::optional(Signature{1}) : std::nullopt;
        },
        [&](const graph::Alignment& a) -> std::optional<Signature> {
          return a.computed_by == kSelf ? std::optional(Signature{2}) : std::nullopt;
        });
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->dropped_nodes, 1u + 1u + 2u + 1u) << "r2/0, a content of r2/1, both of r2/3, one of r1/1";
    EXPECT_EQ(done->dropped_alignments, 1u);
  }
  auto store = Store::open(path, kSelf).value();
  EXPECT_TRUE(store.damage().empty());
  EXPECT_EQ(store.node_set().ranges(), (std::vector<SeqRange>{{kSelf, 0, 2}, {kPeer, 1, 3}}));
  EXPECT_EQ(store.node({kSelf, 0})->signature, Signature{1});
  EXPECT_EQ(store.submap({kSelf, 1}).value(), submap) << "it is the item's again";
  EXPECT_TRUE(is_east(*store.node({kPeer, 1}), 50.0));
  EXPECT_FALSE(store.has_submap({kPeer, 1})) << "it was of the other content";
  EXPECT_TRUE(store.is_contested({kPeer, 2}));
  EXPECT_EQ(store.put_submap({kPeer, 0}, submap).value(), Put::kInvalid);
  EXPECT_EQ(store.alignments().size(), 1u);
  EXPECT_EQ(store.alignment({kSelf, 2})->signature, Signature{2});
}

}  // namespace
}  // namespace fleetmap::store
