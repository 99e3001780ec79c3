#include "fleetmap/exchange/store_union.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/fault_injection/simulated_signatures.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using store::Put;
using testing::agent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::make_alignment;
using testing::make_node;

class StoreUnionTest : public ::testing::Test {
 protected:
  store::Store open(const std::string& name, const std::string& self) {
    return std::move(store::Store::open(folder_ / name, agent(self)).value());
  }
  void put_own(store::Store& store, std::uint32_t seq, std::uint32_t seed = 1) {
    const Bytes submap = testing::random_bytes(700, seed);
    graph::Node node = make_node(store.self(), seq, submap, 0.0, seed);
    if (sign_) node.signature = keys_.sign(node);
    ASSERT_EQ(store.put_node_with_submap(node, submap).value(), Put::kAdded);
  }
  void put_alignment(store::Store& store, std::uint32_t seq, double rmse = 0.2) {
    graph::Alignment made = make_alignment({agent("r1"), 0}, {agent("r1"), 1}, agent("r1"), seq, rmse);
    if (sign_) made.signature = keys_.sign(made);
    ASSERT_EQ(store.put_alignment(made).value(), Put::kAdded);
  }
  StoreUnion add(store::Store& from, const ItemAuthenticator* keys = nullptr) {
    const auto added = add_items(merged_, from, keys);
    EXPECT_TRUE(added) << added.error().message;
    return added.value_or(StoreUnion{});
  }

  const testing::TemporaryFolder folder_;
  const fault_injection::SimulatedSignatures keys_{17};
  bool sign_ = false;
  store::Store merged_ = open("merged.db", "merged");
  store::Store a_ = open("a.db", "r1"), b_ = open("b.db", "r1");
};

TEST_F(StoreUnionTest, HoldsTheItemsOfBothOnce) {
  put_own(a_, 0, 1);
  put_own(a_, 1, 2);
  put_alignment(a_, 0);
  put_own(b_, 0, 1);
  put_own(b_, first_seq(1), 3);
  EXPECT_EQ(add(a_).nodes, 2u);
  const StoreUnion second = add(b_);
  EXPECT_EQ(second.nodes, 1u);
  EXPECT_EQ(second.known, 1u);
  EXPECT_EQ(second.submaps, 1u);
  EXPECT_THAT(second.contested, IsEmpty());
  EXPECT_EQ(merged_.nodes().size(), 3u);
  EXPECT_EQ(merged_.alignments().size(), 1u);
  for (const auto& [id, node] : merged_.nodes()) EXPECT_TRUE(merged_.submap(id)) << to_string(id);
}

TEST_F(StoreUnionTest, TwoContentsOfOneNameAreNamedAndNeitherIsUsedInWhateverOrder) {
  put_own(a_, 0, 1);
  put_own(a_, 1, 2);
  put_alignment(a_, 0, 0.2);
  put_own(b_, 0, 5);
  put_alignment(b_, 0, 0.3);
  add(a_);
  EXPECT_THAT(add(b_).contested, ElementsAre("node r1/0", "alignment r1/0"));
  store::Store other = open("other.db", "merged");
  ASSERT_TRUE(add_items(other, b_, nullptr));
  ASSERT_TRUE(add_items(other, a_, nullptr));
  for (const store::Store* one : {&merged_, &other}) {
    EXPECT_TRUE(one->is_contested({agent("r1"), 0}));
    EXPECT_EQ(one->nodes().size(), 1u);
    EXPECT_TRUE(one->alignments().empty());
  }
  EXPECT_EQ(merged_.node_print({agent("r1"), 0, kEndOfSeqs}), other.node_print({agent("r1"), 0, kEndOfSeqs}));
}

TEST_F(StoreUnionTest, ContestedNamesBringBothContents) {
  put_own(a_, 0, 1);
  put_own(b_, 0, 5);
  add(a_);
  add(b_);
  store::Store again = open("again.db", "merged");
  const auto added = add_items(again, merged_, nullptr);
  ASSERT_TRUE(added);
  EXPECT_THAT(added->contested, ElementsAre("node r1/0"));
  EXPECT_TRUE(again.is_contested({agent("r1"), 0}));
}

TEST_F(StoreUnionTest, WithKeysOnlyWhatItsMakerSignedCounts) {
  put_own(b_, 0, 5);  // a forged content of the name below
  put_own(b_, 7, 6);
  put_alignment(b_, 0);
  sign_ = true;
  put_own(a_, 0, 1);
  put_own(a_, 1, 2);
  put_alignment(a_, 1);
  EXPECT_EQ(add(b_, &keys_).unproven, 3u);
  const StoreUnion genuine = add(a_, &keys_);
  EXPECT_EQ(genuine.unproven, 0u);
  EXPECT_THAT(genuine.contested, IsEmpty());
  EXPECT_EQ(merged_.nodes().size(), 2u);
  EXPECT_EQ(merged_.alignments().size(), 1u);
  EXPECT_TRUE(merged_.has_submap({agent("r1"), 0}));
}

}  // namespace
}  // namespace fleetmap::exchange
