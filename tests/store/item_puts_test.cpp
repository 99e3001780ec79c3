#include <gtest/gtest.h>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::TemporaryFolder;

TEST(ItemPuts, a_name_with_two_contents_ends_the_same_whatever_came_first) {
  const TemporaryFolder folder;
  const Bytes submap = random_bytes(700, 1);
  const auto one = make_node(kPeer, 5, submap);
  const auto two = make_node(kPeer, 5, submap, 30.0);
  const auto alignment = [](double rmse) { return make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2, rmse); };
  const NodeId id{kPeer, 5};
  const SeqRange all{kPeer, 0, 100};
  std::vector<std::uint32_t> prints;
  for (const bool swapped : {false, true}) {
    const auto path = folder / (swapped ? "b.db" : "a.db");
    {
      auto store = Store::open(path, kSelf).value();
      ASSERT_EQ(store.put_node(swapped ? two : one).value(), Put::kAdded);
      ASSERT_EQ(store.put_submap(id, submap).value(), Put::kAdded);
      const std::uint32_t print = store.node_print(all);
      const std::uint64_t revision = store.revision();
      EXPECT_EQ(store.put_node(swapped ? one : two).value(), Put::kConflict);
      EXPECT_NE(store.node_print(all), print);
      EXPECT_GT(store.revision(), revision);
      ASSERT_EQ(store.put_alignment(alignment(swapped ? 0.1 : 0.3)).value(), Put::kAdded);
      EXPECT_EQ(store.put_alignment(alignment(swapped ? 0.3 : 0.1)).value(), Put::kConflict);
    }
    auto store = Store::open(path, kSelf).value();
    EXPECT_FALSE(store.node(id));
    EXPECT_FALSE(store.has_submap(id));
    EXPECT_FALSE(store.alignment({kPeer, 2}));
    EXPECT_TRUE(store.node_set().contains(kPeer, 5)) << "nobody need be asked for it";
    ASSERT_EQ(store.contested_nodes(all).size(), 1u);
    EXPECT_EQ(store.contested_nodes(all)[0].first->G->position, (swapped ? two : one).G->position);
    EXPECT_EQ(store.contested_nodes(all)[0].second->G->position, (swapped ? one : two).G->position);
    EXPECT_EQ(store.contested_alignments(all).size(), 1u);
    EXPECT_TRUE(store.is_contested(id));
    EXPECT_EQ(store.put_node(one).value(), Put::kKnown);
    EXPECT_EQ(store.put_node(make_node(kPeer, 5, submap, 60.0)).value(), Put::kKnown) << "a third one";
    prints.push_back(store.node_print(all) + store.alignment_print(all));
  }
  EXPECT_EQ(prints[0], prints[1]);
}

TEST(ItemPuts, keeps_the_submap_of_an_own_node_whose_name_is_contested) {
  const TemporaryFolder folder;
  const Bytes submap = random_bytes(700, 1);
  const NodeId id{kSelf, 5};
  {
    auto store = Store::open(folder / "store.db", kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(make_node(kSelf, 5, submap), submap).value(), Put::kAdded);
    EXPECT_EQ(store.put_node(make_node(kSelf, 5, submap, 30.0)).value(), Put::kConflict);
    EXPECT_EQ(store.put_node_with_submap(make_node(kSelf, 5, submap, 60.0), submap).value(), Put::kConflict)
        << "no name for another node";
  }
  auto store = Store::open(folder / "store.db", kSelf).value();
  ASSERT_EQ(store.contested_nodes({kSelf, 0, kEndOfSeqs}).size(), 1u);
  EXPECT_TRUE(store.contested_nodes({kPeer, 0, kEndOfSeqs}).empty());
  EXPECT_EQ(store.contested_submap(id).value(), submap);
  EXPECT_FALSE(store.contested_submap({kSelf, 6}));
  EXPECT_EQ(store.next_node_seq(0), 6u);
}

}  // namespace
}  // namespace fleetmap::store
