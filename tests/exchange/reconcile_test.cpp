#include "reconcile.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::make_node;

/// Two robots of which one holds `nodes` nodes of r3, none beside another, and whose digests show three
/// ranges.
class ReconcileTest : public ::testing::Test {
 protected:
  ReconcileTest() { config_.max_ranges = 3; }

  void fill(store::Store& store, std::uint32_t nodes) {
    for (std::uint32_t k = 0; k < nodes; ++k) ASSERT_TRUE(store.put_node(make_node(kMaker, 2 * k, {})));
  }
  store::Store open(const char* name, const AgentId& self) {
    return std::move(store::Store::open(folder_ / name, self).value());
  }

  ReconcileConfig config_;
  testing::TemporaryFolder folder_;
  store::Store store_ = open("r1.db", kSelf);
  store::Store peers_ = open("r2.db", kPeer);
};

TEST_F(ReconcileTest, OfferedItemsAreRequestedUntilTheyAreHeld) {
  fill(peers_, 2);
  Reconcile self(kSelf, config_), peer(kPeer, config_);
  self.on_heard(kPeer, kStart);
  self.on_digest(peer.tick(peers_, kStart).digest.value(), store_, kStart);
  EXPECT_FALSE(self.complete(store_));
  const auto due = self.tick(store_, kStart + std::chrono::seconds(1));
  ASSERT_EQ(due.requests.size(), 1u);
  const auto items = peer.answer(due.requests[0], peers_);
  ASSERT_EQ(items.nodes.size(), 2u);
  for (const graph::Node* node : items.nodes) ASSERT_TRUE(store_.put_node(*node));
  EXPECT_TRUE(self.complete(store_));
}

TEST_F(ReconcileTest, AForgedOfferEndsWhenThePartsOfTheDigestWentRound) {
  fill(store_, 9);
  fill(peers_, 9);
  Reconcile self(kSelf, config_), peer(kPeer, config_);
  const SeqRange forged{kMaker, first_seq(40), first_seq(40) + 5};
  self.on_digest({kPeer, {{kMaker, 5, 6}, {kMaker, 7, 8}, forged}, {}, {}, {}}, store_, kStart);
  ASSERT_FALSE(self.complete(store_));
  Stamp now = kStart;
  for (int k = 0; k < 10; ++k, now += std::chrono::minutes(1)) {
    if (const auto due = peer.tick(peers_, now); due.digest) self.on_digest(*due.digest, store_, now);
  }
  EXPECT_TRUE(self.complete(store_));
  EXPECT_TRUE(self.caught_up(kPeer, store_));
}

/// Otherwise every honest robot would offer a range that the others take for hostile.
TEST_F(ReconcileTest, ItemsOnBothSidesOfTheBorderOfTwoSessionsAreOffered) {
  ASSERT_TRUE(peers_.put_node(make_node(kMaker, first_seq(8) - 1, {})));
  ASSERT_TRUE(peers_.put_node(make_node(kMaker, first_seq(8), {})));
  Reconcile self(kSelf, config_), peer(kPeer, config_);
  self.on_digest(peer.tick(peers_, kStart).digest.value(), store_, kStart);
  EXPECT_EQ(self.stats().hostile, 0u);
  EXPECT_FALSE(self.complete(store_));
}

}  // namespace
}  // namespace fleetmap::exchange
