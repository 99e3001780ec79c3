#include "store_state.hpp"

#include <gtest/gtest.h>

#include "fingerprint.hpp"
#include "row_hash.hpp"
#include "schema.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;

class OpenState : public ::testing::Test {
 protected:
  OpenState() {
    state_.path = folder_ / "store.db";
    state_.self = kSelf;
    state_.db = Database::open(state_.path, false).value();
    EXPECT_TRUE(prepare_schema(*state_.db, state_.path, kSelf));
    EXPECT_TRUE(state_.db->execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL"));
  }
  std::int64_t rows(const std::string& table) {
    return state_.db->integer(("SELECT count(*) FROM " + table).c_str()).value();
  }

  testing::TemporaryFolder folder_;
  StoreState state_;
};

TEST(Chunks, CoverTheSubmapAndTheLastIsItsRest) {
  graph::Node node;
  for (const std::uint32_t bytes :
       {0u, 1u, Store::kChunkBytes - 1, Store::kChunkBytes, Store::kChunkBytes + 1, UINT32_MAX}) {
    node.submap_bytes = bytes;
    const std::uint32_t chunks = chunk_count(node);
    std::uint64_t sum = 0;
    for (std::uint32_t k = 0; k < chunks; ++k) {
      const bool last = k + 1 == chunks;
      ASSERT_GT(chunk_size(node, k), 0u) << bytes;
      ASSERT_TRUE(last || chunk_size(node, k) == Store::kChunkBytes) << bytes;
      sum += chunk_size(node, k);
    }
    EXPECT_EQ(sum, bytes);
  }
}

TEST(StoreState, APartialSubmapBeginsWithAllChunksMissingAndIsKept) {
  StoreState state;
  const graph::Node node = make_node(kPeer, 3, random_bytes(2 * Store::kChunkBytes + 1, 1));
  PartialSubmap& partial = state.partial(node);
  EXPECT_EQ(partial.missing, 3u);
  EXPECT_EQ(partial.held, std::vector<bool>(3, false));
  partial.held[1] = true;
  partial.missing = 2;
  EXPECT_EQ(&state.partial(node), &partial) << "a second call must not begin the download again";
  EXPECT_EQ(state.partial(node).missing, 2u);
}

TEST(StoreState, CountsWhatBecameOfEachPut) {
  StoreState state;
  for (const Put put :
       {Put::kAdded, Put::kKnown, Put::kKnown, Put::kConflict, Put::kInvalid, Put::kInvalid, Put::kInvalid})
    EXPECT_EQ(state.count(put), put);
  EXPECT_EQ(state.stats.added, 1u);
  EXPECT_EQ(state.stats.known, 2u);
  EXPECT_EQ(state.stats.conflicts, 1u);
  EXPECT_EQ(state.stats.invalid, 3u);
}

TEST(StoreState, AContestedNodeIsHeldNoMoreAndKeepsItsAddress) {
  StoreState state;
  const graph::Node one = make_node(kPeer, 5, random_bytes(70, 1)),
                    two = make_node(kPeer, 5, random_bytes(70, 2));
  state.nodes.emplace(one.id, one);
  state.node_prints.set(one.id, fingerprint(one));
  state.submap_set.insert(kPeer, 5);
  state.partial(one);
  const graph::Node* held = state.node(one.id);
  ASSERT_NE(held, nullptr);

  state.contest(two);
  EXPECT_EQ(state.node(one.id), nullptr);
  EXPECT_FALSE(state.has_submap(one.id));
  EXPECT_TRUE(state.partials.empty());
  ASSERT_TRUE(state.contested_nodes.contains(one.id));
  EXPECT_EQ(&state.contested_nodes.at(one.id).first.mapped(), held) << "pointers to it stay valid";
  EXPECT_EQ(state.contested_nodes.at(one.id).second.submap_hash, two.submap_hash);
  EXPECT_EQ(state.node_prints.of({kPeer, 5, 6}), fingerprint_of_contested(one.id));
}

TEST(StoreState, AContestedAlignmentIsHeldNoMore) {
  StoreState state;
  const auto one = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2, 0.1);
  const auto two = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2, 0.3);
  const AlignmentId id{kPeer, 2};
  state.alignments.emplace(id, one);
  state.contest(two);
  EXPECT_TRUE(state.alignments.empty());
  ASSERT_TRUE(state.contested_alignments.contains(id));
  EXPECT_EQ(state.contested_alignments.at(id).first.mapped().modes[0].rmse, one.modes[0].rmse);
  EXPECT_EQ(state.contested_alignments.at(id).second.modes[0].rmse, two.modes[0].rmse);
  EXPECT_EQ(state.alignment_prints.of({kPeer, 2, 3}), fingerprint_of_contested(name_of(id)));
}

TEST_F(OpenState, InsertsARowWithItsHashAndRemovesItAlone) {
  const Bytes item = random_bytes(50, 1), other = random_bytes(60, 2);
  Signature signature{};
  signature[0] = 9;
  ASSERT_TRUE(state_.insert("node", {kPeer, 1}, item, signature));
  ASSERT_TRUE(state_.insert("node", {kPeer, 2}, other, std::nullopt));
  EXPECT_FALSE(state_.insert("node", {kPeer, 1}, other, std::nullopt)) << "names are unique";
  {
    auto row = state_.db->prepare("SELECT * FROM node WHERE seq = 1").value();
    ASSERT_TRUE(row.step().value());
    const auto equal = [&](int column, ByteView expected) {
      return std::ranges::equal(row.blob(column), expected);
    };
    EXPECT_EQ(row.text(0), kPeer.str());
    EXPECT_TRUE(equal(2, item));
    EXPECT_TRUE(equal(3, row_hash(item, signature)));
    EXPECT_TRUE(equal(4, signature));
  }
  ASSERT_TRUE(state_.remove("node", {kPeer, 1}));
  EXPECT_EQ(rows("node"), 1);
  EXPECT_EQ(state_.db->integer("SELECT seq FROM node").value(), 2);
}

TEST_F(OpenState, RemovesASubmapWithItsChunks) {
  const Bytes part = random_bytes(9, 1);
  for (const char* seq : {"1", "2"}) {
    for (const std::string& row : {"submap VALUES('r2', " + std::string(seq) + ", x'00')",
                                   "submap_chunk VALUES('r2', " + std::string(seq) + ", 0, x'00')"}) {
      const Status put = state_.db->execute(("INSERT INTO " + row).c_str());
      ASSERT_TRUE(put) << put.error().message;
    }
  }
  ASSERT_TRUE(state_.remove_submap({kPeer, 1}));
  EXPECT_EQ(rows("submap WHERE seq = 1"), 0);
  EXPECT_EQ(rows("submap_chunk WHERE seq = 1"), 0);
  EXPECT_EQ(rows("submap"), 1) << "those of other nodes stay";
  EXPECT_EQ(rows("submap_chunk"), 1);
}

TEST_F(OpenState, ADurableCommitSyncsInFullAndGoesBackToNormal) {
  std::int64_t during = 0;
  const auto write = [&] {
    during = state_.db->integer("PRAGMA synchronous").value();
    return state_.db->execute("INSERT INTO meta VALUES('key', x'00', x'00')");
  };
  EXPECT_TRUE(state_.commit(false, write));
  EXPECT_EQ(during, 1) << "NORMAL";
  EXPECT_FALSE(state_.synced_changes);
  ASSERT_TRUE(state_.db->execute("DELETE FROM meta WHERE key = 'key'"));

  EXPECT_TRUE(state_.commit(true, write));
  EXPECT_EQ(during, 2) << "FULL";
  EXPECT_EQ(state_.db->integer("PRAGMA synchronous").value(), 1);
  EXPECT_EQ(state_.synced_changes, state_.db->changes());

  const auto synced = state_.synced_changes;
  EXPECT_FALSE(state_.commit(true, write)) << "the key is there";
  EXPECT_EQ(state_.db->integer("PRAGMA synchronous").value(), 1) << "after a failure, too";
  EXPECT_EQ(state_.synced_changes, synced);
}

TEST_F(OpenState, WithoutPowerSafetyNothingIsSyncedInFull) {
  state_.config.power_safe = false;
  std::int64_t during = 0;
  EXPECT_TRUE(state_.commit(true, [&] {
    during = state_.db->integer("PRAGMA synchronous").value();
    return Status{};
  }));
  EXPECT_EQ(during, 1);
}

}  // namespace
}  // namespace fleetmap::store
