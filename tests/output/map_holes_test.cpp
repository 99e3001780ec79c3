#include "fleetmap/output/map_holes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/output/placed_store.hpp"
#include "store/items.hpp"

namespace fleetmap::output {
namespace {

/// The store of r1 with three nodes of r1 and r2 each, and the submaps of r1's and of the first of r2's.
store::Store store_with_holes(const std::filesystem::path& file, bool all) {
  const AgentId r1 = testing::agent("r1"), r2 = testing::agent("r2");
  auto store = store::Store::open(file, r1).value();
  for (std::uint32_t seq = 0; seq < 3; ++seq) {
    const Bytes submap = testing::random_bytes(500, seq);
    EXPECT_TRUE(store.put_node_with_submap(testing::make_node(r1, seq, submap), submap));
    EXPECT_TRUE(store.put_node(testing::make_node(r2, seq, submap)));
    if (!all && seq > 0) continue;
    EXPECT_TRUE(store.put_submap({r2, seq}, submap));
  }
  return store;
}

TEST(MapHoles, AreCountedByRobotWhereSubmapsAreLacking) {
  const testing::TemporaryFolder folder;
  const store::Store store = store_with_holes(folder / "store.db", false);
  const auto holes = map_holes(store, nodes_of(store));
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_EQ(holes.begin()->first, testing::agent("r2"));
  EXPECT_EQ(holes.begin()->second.nodes, 3u);
  EXPECT_EQ(holes.begin()->second.without_submap, 2u);
  EXPECT_THAT(
      text_of_holes(store, nodes_of(store)),
      ::testing::StartsWith("2 of 6 nodes have no submap in this store (r2: 2 of 3), so the map has"));
}

TEST(MapHoles, AWholeStoreHasNone) {
  const testing::TemporaryFolder folder;
  const store::Store store = store_with_holes(folder / "store.db", true);
  EXPECT_TRUE(map_holes(store, nodes_of(store)).empty());
  EXPECT_EQ(text_of_holes(store, nodes_of(store)), "");
}

}  // namespace
}  // namespace fleetmap::output
