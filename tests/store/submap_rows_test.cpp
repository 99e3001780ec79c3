#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/run_sql.hpp"

namespace fleetmap::store {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kPeer;
using testing::kSelf;
using testing::make_node;
using testing::random_bytes;
using testing::run_sql;
using testing::TemporaryFolder;

TEST(SubmapRows, keeps_the_chunks_of_a_download_over_a_restart) {
  const TemporaryFolder folder;
  const Bytes submap = random_bytes(3 * Store::kChunkBytes + 5, 1);
  const NodeId id{kPeer, 0};
  const auto chunk = [&](std::uint32_t index) {
    const ByteView all(submap);
    const std::size_t offset = index * Store::kChunkBytes;
    return all.subspan(offset, std::min<std::size_t>(Store::kChunkBytes, all.size() - offset));
  };
  {
    auto store = Store::open(folder / "store.db", kSelf).value();
    ASSERT_EQ(store.put_node(make_node(kPeer, 0, submap)).value(), Put::kAdded);
    EXPECT_EQ(store.missing_chunks(id), (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(store.put_submap_chunk(id, 3, chunk(3)).value(), Put::kAdded);
    EXPECT_EQ(store.put_submap_chunk(id, 1, chunk(1)).value(), Put::kAdded);
    EXPECT_EQ(store.put_submap_chunk(id, 1, chunk(1)).value(), Put::kKnown);
    EXPECT_EQ(store.put_submap_chunk(id, 4, chunk(3)).value(), Put::kInvalid);
    EXPECT_EQ(store.put_submap_chunk(id, 0, chunk(3)).value(), Put::kInvalid);
    EXPECT_FALSE(store.has_submap(id));
  }
  auto store = Store::open(folder / "store.db", kSelf).value();
  EXPECT_EQ(store.partial_submaps(), std::vector<NodeId>{id});
  EXPECT_EQ(store.missing_chunks(id), (std::vector<std::uint32_t>{0, 2}));
  ASSERT_EQ(store.put_submap_chunk(id, 0, chunk(0)).value(), Put::kAdded);
  EXPECT_EQ(store.put_submap_chunk(id, 2, chunk(2)).value(), Put::kAdded);
  EXPECT_TRUE(store.has_submap(id));
  EXPECT_EQ(store.submap(id).value(), submap);
  EXPECT_EQ(store.submap_part(id, Store::kChunkBytes, 10).value(),
            Bytes(&submap[Store::kChunkBytes], &submap[Store::kChunkBytes + 10]));
  EXPECT_TRUE(store.partial_submaps().empty());
}

TEST(SubmapRows, drops_a_download_with_the_wrong_content) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const Bytes submap = random_bytes(Store::kChunkBytes + 7, 1);
  const NodeId id{kPeer, 0};
  ASSERT_EQ(store.put_node(make_node(kPeer, 0, submap)).value(), Put::kAdded);
  ASSERT_EQ(store.put_submap_chunk(id, 0, random_bytes(Store::kChunkBytes, 9)).value(), Put::kAdded);
  EXPECT_EQ(store.put_submap_chunk(id, 1, ByteView(submap).subspan(Store::kChunkBytes)).value(),
            Put::kInvalid);
  EXPECT_EQ(store.stats().bad_submaps, 1u);
  EXPECT_EQ(store.missing_chunks(id).size(), 2u);
  EXPECT_EQ(store.put_submap(id, submap).value(), Put::kAdded);
  EXPECT_EQ(store.submap(id).value(), submap);
}

TEST(SubmapRows, a_node_without_a_submap_has_nothing_that_could_be_damaged) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  graph::Node node = make_node(kPeer, 0, {});
  node.submap_hash = content_hash(random_bytes(9, 1));  // of a liar
  ASSERT_EQ(store.put_node(node).value(), Put::kAdded);
  ASSERT_TRUE(store.has_submap(node.id));
  EXPECT_TRUE(store.submap(node.id).value().empty());
  EXPECT_TRUE(store.has_submap(node.id));
}

TEST(SubmapRows, drops_a_submap_that_the_disk_damaged) {
  const TemporaryFolder folder;
  const auto path = folder / "store.db";
  const Bytes submap = random_bytes(5000, 1);
  {
    auto store = Store::open(path, kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(make_node(kSelf, 0, submap), submap).value(), Put::kAdded);
  }
  const char* damage = "UPDATE submap SET bytes = zeroblob(5000)";
  run_sql(path, damage);
  auto store = Store::open(path, kSelf).value();
  EXPECT_THAT(store.damage(), ElementsAre(HasSubstr("the submap of node r1/0 is damaged")));
  EXPECT_FALSE(store.has_submap({kSelf, 0})) << "nobody need read it to find out";
  // While it runs.
  ASSERT_EQ(store.put_submap({kSelf, 0}, submap).value(), Put::kAdded);
  run_sql(path, damage);
  const auto read = store.submap({kSelf, 0});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("damaged"));
  EXPECT_FALSE(store.has_submap({kSelf, 0}));
  EXPECT_EQ(store.missing_chunks({kSelf, 0}).size(), 1u);
  EXPECT_EQ(store.put_submap({kSelf, 0}, submap).value(), Put::kAdded);
}

}  // namespace
}  // namespace fleetmap::store
