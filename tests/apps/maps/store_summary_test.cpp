#include "maps/store_summary.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::make_alignment;
using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;
using store::Store;

constexpr std::uint32_t kChunk = Store::kChunkBytes;

class StoreSummary : public ::testing::Test {
 protected:
  Store opened(const std::string& robot) {
    return Store::open(folder_ / (robot + ".db"), agent(robot)).value();
  }
  /// A node of r2 in a session of its own, with the first `bytes` of its submap of three chunks.
  static graph::Node put(Store& store, std::uint16_t session, std::uint32_t seq, std::size_t bytes) {
    const Bytes submap = random_bytes(kWhole, seq + 1);
    graph::Node node = make_node(agent("r2"), first_seq(session) + seq, submap);
    node.session = session;
    EXPECT_EQ(store.put_node(node).value(), store::Put::kAdded);
    if (bytes == submap.size()) {
      EXPECT_EQ(store.put_submap(node.id, submap).value(), store::Put::kAdded);
    } else {
      for (std::uint32_t chunk = 0; (chunk + 1) * kChunk <= bytes; ++chunk)
        EXPECT_TRUE(store.put_submap_chunk(node.id, chunk, ByteView(submap).subspan(chunk * kChunk, kChunk)));
    }
    return node;
  }
  static constexpr std::size_t kWhole = 3 * kChunk;

  fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(StoreSummary, EmptyStoreHasZeroCounts) {
  const auto json = summary_of(opened("r1"));
  EXPECT_EQ(json["store_of"], "r1");
  for (const char* count : {"nodes", "alignments", "submaps", "submap_bytes"})
    EXPECT_EQ(json[count], 0) << count;
  EXPECT_TRUE(json["robots"].is_object());
  EXPECT_TRUE(json["robots"].empty());
}

TEST_F(StoreSummary, CountsByRobotAndSessionWithTheBytesOfPartialSubmaps) {
  Store store = opened("r1");
  const graph::Node first = put(store, 7, 0, kWhole), second = put(store, 7, 1, kChunk);
  put(store, 9, 0, 2 * kChunk);
  put(store, 9, 1, 0);
  ASSERT_EQ(store.put_alignment(make_alignment(first.id, second.id, agent("r2"), 0)).value(),
            store::Put::kAdded);
  const auto json = summary_of(store);
  EXPECT_EQ(json["nodes"], 4);
  EXPECT_EQ(json["alignments"], 1);
  EXPECT_EQ(json["submaps"], 1);
  EXPECT_EQ(json["submap_bytes"], kWhole + 3 * kChunk);
  ASSERT_EQ(json["robots"].size(), 1u);
  EXPECT_EQ(json["robots"]["r2"]["nodes"], 4);
  EXPECT_EQ(json["robots"]["r2"]["alignments"], 1);
  EXPECT_EQ(json["robots"]["r2"]["submaps"], 1);
  EXPECT_EQ(json["robots"]["r2"]["sessions"], 2);
}

TEST_F(StoreSummary, TheHashIsThatOfTheItemsWhoeverHoldsThemAndInWhateverOrder) {
  Store first = opened("r1"), second = opened("r3");
  put(first, 7, 0, kWhole);
  put(first, 7, 1, 0);
  put(second, 7, 1, 0);
  EXPECT_NE(summary_of(first)["hash"], summary_of(second)["hash"]);
  put(second, 7, 0, 0);
  EXPECT_NE(summary_of(first)["hash"], summary_of(second)["hash"]) << "a submap is missing";
  const NodeId id{agent("r2"), first_seq(7)};
  ASSERT_EQ(second.put_submap(id, random_bytes(kWhole, 1)).value(), store::Put::kAdded);
  EXPECT_EQ(summary_of(first)["hash"], summary_of(second)["hash"]);
  EXPECT_EQ(summary_of(first)["hash"].get<std::string>().size(), 32u);
}

TEST_F(StoreSummary, AShortLastChunkThatIsMissingCountsItsOwnBytes) {
  Store held = opened("r1");
  const Bytes submap = random_bytes(5 * kChunk / 2, 1);
  graph::Node node = make_node(agent("r2"), first_seq(7), submap);
  node.session = 7;
  ASSERT_EQ(held.put_node(node).value(), store::Put::kAdded);
  ASSERT_TRUE(held.put_submap_chunk(node.id, 0, ByteView(submap).first(kChunk)));
  EXPECT_EQ(summary_of(held)["submap_bytes"], kChunk);
}

}  // namespace
}  // namespace fleetmap::apps
