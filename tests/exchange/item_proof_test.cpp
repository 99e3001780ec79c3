#include "fleetmap/exchange/item_proof.hpp"

#include <gtest/gtest.h>

#include <set>

#include "exchange/robots.hpp"
#include "fleetmap/fault_injection/simulated_signatures.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using fault_injection::SimulatedSignatures;
using store::Put;
using testing::make_alignment;
using testing::make_node;

/// A store that was filled before the fleet had keys.
class AdoptedItemsTest : public ::testing::Test {
 protected:
  void put_own(const graph::Node& node, const Bytes& submap) {
    ASSERT_EQ(store_.put_node_with_submap(node, submap).value(), Put::kAdded);
  }
  void put(const graph::Node& node, Put expected = Put::kAdded) {
    ASSERT_EQ(store_.put_node(node).value(), expected);
  }
  void put(const graph::Alignment& alignment) {
    ASSERT_EQ(store_.put_alignment(alignment).value(), Put::kAdded);
  }
  /// Signed and dropped.
  std::pair<std::size_t, std::size_t> adopt(const ItemAuthenticator& keys) {
    const auto adopted = adopt_items(store_, keys);
    EXPECT_TRUE(adopted) << adopted.error().message;
    return adopted ? std::pair(adopted->signed_own, adopted->dropped) : std::pair<std::size_t, std::size_t>();
  }
  bool all_genuine(const SimulatedSignatures& keys) const {
    for (const auto& [id, node] : store_.nodes())
      if (keys.verify(node) != ItemProof::kGenuine) return false;
    for (const auto& [id, alignment] : store_.alignments())
      if (keys.verify(alignment) != ItemProof::kGenuine) return false;
    return true;
  }

  const testing::TemporaryFolder folder_;
  store::Store store_ = store::Store::open(folder_ / "store.db", kSelf).value();
  const SimulatedSignatures keys_{17};
  const Bytes submap_ = testing::random_bytes(700, 1);
};

TEST_F(AdoptedItemsTest, OwnItemsAreSignedAndThoseOfOthersDropped) {
  put_own(make_node(kSelf, 0, submap_), submap_);
  put(make_node(kPeer, 0, submap_));
  put(make_alignment({kSelf, 0}, {kPeer, 0}, kSelf, 0));
  put(make_alignment({kSelf, 0}, {kPeer, 0}, kPeer, 3));
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{2}, std::size_t{2}));
  EXPECT_EQ(store_.nodes().size(), 1u);
  EXPECT_EQ(store_.alignments().size(), 1u);
  EXPECT_TRUE(store_.node({kSelf, 0}));
  EXPECT_TRUE(store_.alignment({kSelf, 0}));
  EXPECT_TRUE(all_genuine(keys_));
  EXPECT_EQ(store_.submap({kSelf, 0}).value(), submap_);
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{0}, std::size_t{0})) << "once is enough";
}

TEST_F(AdoptedItemsTest, InAnAdoptedStoreOnlyWhatIsUnsignedIsLookedAt) {
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{0}, std::size_t{0}));
  // It was verified when it came; the certificate need not be at hand any more.
  graph::Node theirs = make_node(kPeer, 0, submap_);
  theirs.signature.emplace().fill(5);
  put(theirs);
  put(make_node(kPeer, 1, submap_));
  put_own(make_node(kSelf, 0, submap_), submap_);
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{1}, std::size_t{1}));
  ASSERT_TRUE(store_.node({kPeer, 0}));
  EXPECT_EQ(store_.node({kPeer, 0})->signature, theirs.signature);
  EXPECT_FALSE(store_.node({kPeer, 1}));
  EXPECT_EQ(keys_.verify(*store_.node({kSelf, 0})), ItemProof::kGenuine);
}

TEST_F(AdoptedItemsTest, KeysOfAnotherFleetReplaceThoseOfTheFirst) {
  put_own(make_node(kSelf, 0, submap_), submap_);
  adopt(keys_);
  graph::Node theirs = make_node(kPeer, 0, submap_);
  theirs.signature = keys_.sign(theirs);
  put(theirs);
  const SimulatedSignatures others(18);
  EXPECT_EQ(adopt(others), std::pair(std::size_t{1}, std::size_t{1}));
  EXPECT_TRUE(all_genuine(others));
  EXPECT_FALSE(store_.node({kPeer, 0}));
}

TEST_F(AdoptedItemsTest, ContestedOwnNameBelongsToTheContentWhoseSubmapIsHeld) {
  const graph::Node own = make_node(kSelf, 0, submap_);
  put_own(own, submap_);
  put(make_node(kSelf, 0, submap_, 30.0), Put::kConflict);
  // One that came back after a loss, and then its forgery: no submap shows which is which.
  put(make_node(kSelf, 7, submap_));
  put(make_node(kSelf, 7, submap_, 30.0), Put::kConflict);
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{1}, std::size_t{3}));
  EXPECT_FALSE(store_.is_contested({kSelf, 0}));
  ASSERT_TRUE(store_.node({kSelf, 0}));
  EXPECT_EQ(store_.node({kSelf, 0})->G->position, own.G->position);
  EXPECT_FALSE(store_.is_contested({kSelf, 7}));
  EXPECT_FALSE(store_.node({kSelf, 7}));
}

/// The node was sent again under a fresh name, so that the contested one would come twice.
TEST_F(AdoptedItemsTest, AContestedNodeThatHasANewNameIsDropped) {
  const graph::Node own = make_node(kSelf, 0, submap_);
  put_own(own, submap_);
  put(make_node(kSelf, 0, submap_, 30.0), Put::kConflict);
  graph::Node again = own;
  again.id.seq = first_seq(9);
  put_own(again, submap_);
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{1}, std::size_t{2}));
  EXPECT_FALSE(store_.node({kSelf, 0}));
  EXPECT_TRUE(store_.node(again.id));
}

TEST_F(AdoptedItemsTest, AContestedOwnAlignmentIsDropped) {
  put(make_alignment({kSelf, 0}, {kPeer, 0}, kSelf, 0, 0.1));
  ASSERT_EQ(store_.put_alignment(make_alignment({kSelf, 0}, {kPeer, 0}, kSelf, 0, 0.2)).value(),
            Put::kConflict);
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{0}, std::size_t{2}));
  EXPECT_TRUE(store_.alignment_set().empty());
}

TEST_F(AdoptedItemsTest, TheStoreIsThatOfTheFleetAfterARestart) {
  put_own(make_node(kSelf, 0, submap_), submap_);
  adopt(keys_);
  { const store::Store closed = std::move(store_); }
  store_ = store::Store::open(folder_ / "store.db", kSelf).value();
  EXPECT_TRUE(all_genuine(keys_));
  EXPECT_EQ(adopt(keys_), std::pair(std::size_t{0}, std::size_t{0}));
}

TEST(ItemProof, EachResultHasASentenceOfItsOwn) {
  std::set<std::string> sentences;
  for (std::size_t k = 0; k < kItemProofs; ++k) sentences.insert(to_string(static_cast<ItemProof>(k)));
  EXPECT_EQ(sentences.size(), kItemProofs);
  EXPECT_FALSE(sentences.contains(""));
  EXPECT_STREQ(to_string(ItemProof::kUnsigned), "it bears no signature");
}

}  // namespace
}  // namespace fleetmap::exchange
