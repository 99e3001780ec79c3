#include "item_exchange.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/recorded_cloud_client.hpp"
#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::make_alignment;
using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;

class ItemExchangeTest : public ::testing::Test {
 protected:
  static ExchangeConfig config() {
    ExchangeConfig config;
    config.fleet = config.on_radio = {kSelf, kPeer};
    config.payload_size = [](const Message&) { return std::size_t{10}; };
    return config;
  }
  template <class Wanted>
  std::size_t count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(events_, [](const Event& e) { return std::holds_alternative<Wanted>(e); }));
  }

  ExchangeConfig config_ = config();
  fleetmap::testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  RecordedCloudClient closer_;
  Membership members_{kSelf, config_.fleet};
  Outbox outbox_{kSelf, config_};
  std::vector<Event> events_;
  ItemExchange items_{config_, store_, closer_, members_, outbox_, events_, kStart};
  NeighbourTable neighbours_{kSelf, {}};
};

TEST_F(ItemExchangeTest, OwnItemsAreStoredSentAndReportedToLoopClosing) {
  outbox_.set_receivers({}, {kPeer});
  const Bytes submap = random_bytes(100, 1);
  const graph::Node node = make_node(kSelf, 0, submap);
  EXPECT_EQ(items_.add_own(node, submap, kStart).value(), store::Put::kAdded);
  EXPECT_EQ(items_.add_own(node, submap, kStart).value(), store::Put::kKnown);
  EXPECT_EQ(outbox_.queue().size(Priority::kNews), 1u);
  EXPECT_EQ(closer_.nodes, std::vector{node.id});
  EXPECT_TRUE(events_.empty()) << "own items are no news to the agent";
}

TEST_F(ItemExchangeTest, ItemsOfMembersAreStoredOnceWhoeverHandsThemOver) {
  const graph::Node node = make_node(kPeer, 0, random_bytes(100, 1));
  items_.receive(node, {Reach::kShortRange, kStranger}, kStart);
  items_.receive(node, {}, kStart);
  items_.receive(make_alignment({kSelf, 0}, node.id, kPeer, 0), {}, kStart);
  EXPECT_EQ(count<NodeAdded>(), 1u);
  EXPECT_EQ(count<AlignmentAdded>(), 1u);
  EXPECT_EQ(closer_.nodes.size(), 1u);
  EXPECT_EQ(closer_.alignments.size(), 1u);
}

TEST_F(ItemExchangeTest, ItemsOfStrangersAreRefused) {
  items_.receive(make_node(kStranger, 0, {}), {}, kStart);
  items_.receive(make_alignment({kSelf, 0}, {kStranger, 0}, kPeer, 0), {}, kStart);
  EXPECT_EQ(members_.strangers(), 2u);
  EXPECT_TRUE(events_.empty() && store_.nodes().empty() && store_.alignments().empty());
}

TEST_F(ItemExchangeTest, ASecondContentOfANameIsAConflictThatNamesItsSender) {
  items_.receive(make_node(kPeer, 0, random_bytes(100, 1)), {}, kStart);
  items_.receive(make_node(kPeer, 0, random_bytes(100, 2)), {Reach::kShortRange, kPeer}, kStart);
  ASSERT_EQ(count<ItemConflict>(), 1u);
  const auto& conflict = std::get<ItemConflict>(events_.back());
  EXPECT_EQ(conflict.id, (NodeId{kPeer, 0}));
  EXPECT_EQ(conflict.link, Reach::kShortRange);
  EXPECT_EQ(conflict.from, kPeer);
  EXPECT_EQ(closer_.contested, std::vector{conflict.id});
}

TEST_F(ItemExchangeTest, AnItemOfTheRunningSessionThatWeHaveNotMadeIsForged) {
  const graph::Node node = make_node(kSelf, first_seq(7), random_bytes(100, 1));
  items_.begin_session(7);
  items_.receive(node, {}, kStart);
  EXPECT_EQ(count<ItemConflict>(), 1u);
  EXPECT_TRUE(store_.nodes().empty());
  items_.begin_session(8);
  items_.receive(node, {}, kStart);
  EXPECT_EQ(count<NodeAdded>(), 1u) << "an own item of an earlier session comes back";
}

TEST_F(ItemExchangeTest, AnOfferedItemIsRequestedAndTheMapCompleteOnceItsSubmapIsHeldToo) {
  const Bytes submap = random_bytes(100, 1);
  EXPECT_TRUE(items_.complete(neighbours_, {}));
  items_.on_digest({kPeer, {{kPeer, 0, 1}}, {}}, kStart);
  EXPECT_FALSE(items_.complete(neighbours_, {}));
  items_.tick(kStart + std::chrono::seconds(2));
  EXPECT_EQ(outbox_.queue().size(Priority::kControl), 1u);
  items_.receive(make_node(kPeer, 0, submap), {}, kStart);
  EXPECT_FALSE(items_.complete(neighbours_, {})) << "without its submap";
  ASSERT_TRUE(store_.put_submap_chunk({kPeer, 0}, 0, submap));
  items_.on_submap({kPeer, 0});
  EXPECT_TRUE(items_.complete(neighbours_, {}));
}

TEST_F(ItemExchangeTest, RequestedItemsGoToTheRobotThatAsked) {
  const Bytes submap = random_bytes(100, 1);
  ASSERT_TRUE(items_.add_own(make_node(kSelf, 0, submap), submap, kStart));
  items_.on_request({kPeer, kSelf, {{kSelf, 0, 5}}, {}});
  EXPECT_EQ(outbox_.queue().size(Priority::kBackfill), 1u);
}

}  // namespace
}  // namespace fleetmap::exchange
