#include "cloud_exchange.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/recorded_cloud_client.hpp"
#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::random_bytes;

const std::vector<AgentId> kOthers{kPeer, kThird};
const NodeId kOurs{kSelf, 0}, kTheirs{kPeer, 0};

class CloudExchangeTest : public ::testing::Test {
 protected:
  CloudExchangeTest() {
    const Bytes submap = random_bytes(100, 1);
    EXPECT_TRUE(store_.put_node_with_submap(fleetmap::testing::make_node(kSelf, 0, submap), submap));
  }

  fleetmap::testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  RecordedCloudClient closer_;
  SendQueue queue_{{}, kOthers, [](const Message&) { return std::size_t{10}; }};
  std::vector<Event> events_;
  CloudExchange clouds_{{}, store_, closer_, queue_, events_};
};

TEST_F(CloudExchangeTest, ARequestNeedsTheCloudOnceAndTheCloudGoesToAllWhoRequestedIt) {
  clouds_.on_request({kPeer, kSelf, kOurs, {}, 1.0f}, kStart);
  clouds_.on_request({kThird, kSelf, kOurs, {}, 1.0f}, kStart + std::chrono::seconds(1));
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(std::get<CloudNeeded>(events_[0]).node, kOurs);
  EXPECT_FALSE(clouds_.idle({}));
  ASSERT_TRUE(clouds_.provide(kOurs, random_bytes(3000, 2), kStart));
  EXPECT_EQ(queue_.size(Priority::kCloud), 6u) << "three pieces to each of two robots";
  EXPECT_TRUE(clouds_.idle({}));
  clouds_.on_request({kPeer, kSelf, kOurs, {0}, 1.0f}, kStart);
  EXPECT_EQ(events_.size(), 1u) << "a cloud that was made is kept";
}

TEST_F(CloudExchangeTest, AnUnansweredRequestIsReportedAgainAfterTheTimeout) {
  const CloudRequest request{kPeer, kSelf, kOurs, {}, 1.0f};
  clouds_.on_request(request, kStart);
  clouds_.on_request(request, kStart + CloudTransferConfig().first_timeout);
  EXPECT_EQ(events_.size(), 2u);
  clouds_.decline(kOurs);
  EXPECT_TRUE(clouds_.idle({}));
}

TEST_F(CloudExchangeTest, RequestsForOtherNodesAreCountedAndIgnored) {
  clouds_.on_request({kPeer, kSelf, kTheirs, {}, 1.0f}, kStart);
  clouds_.on_request({kPeer, kSelf, {kSelf, 9}, {}, 1.0f}, kStart);
  EXPECT_EQ(clouds_.bad_requests(), 2u);
  EXPECT_TRUE(events_.empty() && closer_.requests.empty());
}

TEST_F(CloudExchangeTest, ADemandedCloudIsRequestedAndHandedOverOnceItIsWhole) {
  closer_.demand.wanted = {{kTheirs, 2.0}};
  clouds_.tick(true, kStart);
  EXPECT_TRUE(closer_.had_room);
  EXPECT_EQ(queue_.size(Priority::kControl), 1u);
  const Bytes cloud = random_bytes(2000, 3);
  for (const CloudFragment& fragment : split_cloud(kPeer, kSelf, kTheirs, cloud)) {
    EXPECT_TRUE(closer_.clouds.empty());
    clouds_.on_fragment(fragment, kStart);
  }
  ASSERT_EQ(closer_.clouds.size(), 1u);
  EXPECT_EQ(closer_.clouds[0], std::pair(kTheirs, cloud));
}

TEST_F(CloudExchangeTest, AWithdrawnPairEndsBothTransfers) {
  ASSERT_TRUE(clouds_.provide(kOurs, random_bytes(3000, 2), kStart));
  clouds_.on_request({kPeer, kSelf, kOurs, {}, 1.0f}, kStart);
  closer_.demand.wanted = {{kTheirs, 2.0}};
  clouds_.tick(false, kStart);
  EXPECT_EQ(queue_.size(Priority::kCloud), 3u);
  EXPECT_FALSE(clouds_.idle({}));
  closer_.demand.withdrawn = {{kOurs, kTheirs}};
  clouds_.tick(false, kStart);
  EXPECT_EQ(queue_.size(Priority::kCloud), 0u);
  EXPECT_TRUE(clouds_.idle({}));
}

TEST_F(CloudExchangeTest, AGoodOwnAlignmentEndsTheTransferOfOurCloudToThePeer) {
  ASSERT_TRUE(clouds_.provide(kOurs, random_bytes(3000, 2), kStart));
  clouds_.on_request({kPeer, kSelf, kOurs, {}, 1.0f}, kStart);
  clouds_.on_own_alignment(fleetmap::testing::make_alignment(kOurs, kTheirs, kSelf, 0, 0.9));
  EXPECT_EQ(queue_.size(Priority::kCloud), 3u) << "E_ij is too large";
  clouds_.on_own_alignment(fleetmap::testing::make_alignment(kOurs, kTheirs, kSelf, 0, 0.2));
  EXPECT_EQ(queue_.size(Priority::kCloud), 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
