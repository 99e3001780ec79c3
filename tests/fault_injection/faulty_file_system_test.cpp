#include "faulty_file_system.hpp"

#include <gtest/gtest.h>

#include "fleetmap/store/store.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using testing::agent;

TEST(FaultyFileSystem, a_store_on_a_full_disk_refuses_items_and_goes_on_when_there_is_room) {
  const testing::TemporaryFolder folder;
  FaultyFileSystem disk;
  store::StoreConfig config;
  config.file_system = disk.name();
  const Bytes submap = testing::random_bytes(9000, 1);
  {
    auto store = store::Store::open(folder / "r1.db", agent("r1"), config).value();
    const auto put = [&](std::uint32_t seq) {
      return store.put_node_with_submap(testing::make_node(agent("r1"), seq, submap), submap);
    };
    EXPECT_EQ(put(0).value(), store::Put::kAdded);
    disk.set_full(true);
    EXPECT_FALSE(put(1));
    EXPECT_EQ(store.nodes().size(), 1u);
    disk.set_full(false);
    EXPECT_EQ(put(1).value(), store::Put::kAdded);
    disk.set_full(true);
  }
  disk.set_full(false);
  const auto store = store::Store::open(folder / "r1.db", agent("r1"), config).value();
  EXPECT_EQ(store.nodes().size(), 2u) << "closing on a full disk loses nothing";
}

TEST(FaultyFileSystem, a_store_on_a_disk_that_becomes_read_only_says_so_and_keeps_what_it_has) {
  const testing::TemporaryFolder folder;
  FaultyFileSystem disk;
  store::StoreConfig config;
  config.file_system = disk.name();
  auto store = store::Store::open(folder / "r1.db", agent("r1"), config).value();
  EXPECT_EQ(store.put_node(testing::make_node(agent("r2"), 0, Bytes{})).value(), store::Put::kAdded);
  disk.set_read_only(true);
  const auto refused = store.put_node(testing::make_node(agent("r2"), 1, Bytes{}));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find((folder / "r1.db").string()), std::string::npos);
  EXPECT_NE(refused.error().message.find("read-only"), std::string::npos) << refused.error().message;
  EXPECT_EQ(store.nodes().size(), 1u);
  disk.set_read_only(false);
  EXPECT_EQ(store.put_node(testing::make_node(agent("r2"), 1, Bytes{})).value(), store::Put::kAdded);
}

}  // namespace
}  // namespace fleetmap::fault_injection
