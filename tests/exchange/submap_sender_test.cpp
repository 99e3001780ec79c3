#include "submap_sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "exchange/robots.hpp"
#include "exchange/submap_chunks.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Stamp at(double seconds) { return stamp_from_ns(1'000'000'000) + from_seconds(seconds); }

/// A robot that holds two own submaps, each of three chunks, the last one of 100 B.
class SubmapSenderTest : public ::testing::Test {
 protected:
  SubmapSenderTest() {
    for (std::uint32_t seq = 0; seq < 2; ++seq) {
      submaps_.push_back(testing::random_bytes(2 * kChunk + 100, seq));
      EXPECT_TRUE(store_.put_node_with_submap(testing::make_node(kSelf, seq, submaps_[seq]), submaps_[seq]));
    }
  }
  SubmapRequest request(const AgentId& from, std::uint32_t seq, std::uint32_t offset,
                        std::uint32_t length) const {
    return {from, kSelf, {kSelf, seq}, offset, length};
  }

  const testing::TemporaryFolder folder_;
  store::Store store_ = store::Store::open(folder_ / "store.db", kSelf).value();
  std::vector<Bytes> submaps_;
  SubmapTransferConfig config_;
};

TEST_F(SubmapSenderTest, TheDigestTellsWhatIsHeldAndWhoIsHeardOncePerPeriod) {
  SubmapSender sender(kSelf, config_);
  const auto first = sender.digest(store_, {kPeer}, at(0.0));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->from, kSelf);
  EXPECT_THAT(first->submaps, ElementsAre(SeqRange{kSelf, 0, 2}));
  EXPECT_THAT(first->hears, ElementsAre(kPeer));
  EXPECT_FALSE(sender.digest(store_, {}, at(0.99)));
  EXPECT_TRUE(sender.digest(store_, {}, at(1.0)));
  EXPECT_FALSE(sender.digest(store_, {}, at(1.5)));
  sender.on_newcomer();
  EXPECT_TRUE(sender.digest(store_, {}, at(1.5))) << "who has come need not wait";
  EXPECT_FALSE(sender.digest(store_, {}, at(2.4)));
}

TEST_F(SubmapSenderTest, DigestsWithLittleRoomGoRound) {
  config_.max_ranges = 2;
  for (const std::uint32_t seq : {10u, 20u, 30u}) {
    EXPECT_TRUE(store_.put_node(testing::make_node(kPeer, seq, submaps_[0])));
    EXPECT_TRUE(store_.put_submap({kPeer, seq}, submaps_[0]));
  }
  SubmapSender sender(kSelf, config_);
  store::SeqSet told;
  for (int k = 0; k < 4; ++k) {
    const auto digest = sender.digest(store_, {}, at(k));
    ASSERT_TRUE(digest);
    EXPECT_LE(digest->submaps.size(), 2u);
    for (const SeqRange& range : digest->submaps) told.insert(range);
  }
  EXPECT_EQ(told, store_.submap_set());
}

TEST_F(SubmapSenderTest, SendsTheChunksThatWereAskedFor) {
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 1, kChunk, 1'000'000), store_);
  EXPECT_FALSE(sender.idle());
  const auto chunks = sender.tick(store_, at(0.0));
  ASSERT_THAT(chunks, SizeIs(2));
  for (std::size_t k = 0; k < 2; ++k) {
    const auto offset = static_cast<std::uint32_t>(k + 1) * kChunk;
    EXPECT_EQ(chunks[k].from, kSelf);
    EXPECT_EQ(chunks[k].to, kPeer);
    EXPECT_EQ(chunks[k].node, (NodeId{kSelf, 1}));
    EXPECT_EQ(chunks[k].offset, offset);
    EXPECT_EQ(chunks[k].total_bytes, submaps_[1].size());
    const auto begin = submaps_[1].begin() + offset;
    EXPECT_EQ(chunks[k].payload, Bytes(begin, k == 0 ? begin + kChunk : submaps_[1].end()));
  }
  EXPECT_TRUE(sender.idle());
  EXPECT_EQ(sender.stats().chunks, 2u);
  EXPECT_EQ(sender.stats().bytes, kChunk + 100u);
}

TEST_F(SubmapSenderTest, APartOfAChunkIsTheWholeChunkAndNoneIsQueuedTwice) {
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 1), store_);
  sender.on_request(request(kPeer, 0, 0, kChunk + 1), store_);
  const auto chunks = sender.tick(store_, at(0.0));
  ASSERT_THAT(chunks, SizeIs(2));
  EXPECT_EQ(chunks[0].offset, 0u);
  EXPECT_EQ(chunks[0].payload.size(), kChunk);
  EXPECT_EQ(chunks[1].offset, kChunk);
  sender.on_request(request(kPeer, 0, 0, 1), store_);
  EXPECT_THAT(sender.tick(store_, at(1.0)), SizeIs(1)) << "it was lost on the way";
}

TEST_F(SubmapSenderTest, RefusesAndCountsWhatIsNotHeldOrDoesNotExist) {
  SubmapSender sender(kSelf, config_);
  EXPECT_TRUE(store_.put_node(testing::make_node(kPeer, 5, submaps_[0])));  // without its submap
  for (const SubmapRequest& bad :
       {SubmapRequest{kPeer, kSelf, {kPeer, 5}, 0, 10}, SubmapRequest{kPeer, kSelf, {kPeer, 6}, 0, 10},
        request(kPeer, 0, 1, 10), request(kPeer, 0, 0, 0), request(kPeer, 0, 3 * kChunk, 10),
        request(kPeer, 0, 0xffffe000, 0xffffffff)})
    sender.on_request(bad, store_);
  EXPECT_EQ(sender.stats().requests, 6u);
  EXPECT_EQ(sender.stats().refused, 6u);
  sender.on_request({kPeer, kThird, {kSelf, 0}, 0, 10}, store_);
  EXPECT_EQ(sender.stats().requests, 6u) << "of another robot";
  EXPECT_TRUE(sender.idle());
  EXPECT_THAT(sender.tick(store_, at(0.0)), IsEmpty());
}

TEST_F(SubmapSenderTest, PeersAreServedInTurns) {
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 1'000'000), store_);
  sender.on_request(request(kPeer, 1, 0, 1'000'000), store_);
  sender.on_request(request(kThird, 1, 0, 1'000'000), store_);
  EXPECT_EQ(sender.peers(), 2u);
  std::vector<AgentId> order;
  for (const SubmapChunk& chunk : sender.tick(store_, at(0.0))) order.push_back(chunk.to);
  EXPECT_THAT(order, ElementsAre(kPeer, kThird, kPeer, kThird, kPeer, kThird, kPeer, kPeer, kPeer));
}

TEST_F(SubmapSenderTest, TheRateOfTheLinkIsKeptWithOverheads) {
  config_.bytes_per_second = 10'000.0;
  config_.overhead_bytes = 10'000 - kChunk;  // a chunk a second
  config_.burst_bytes = 10'000.0;
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 2 * kChunk), store_);
  sender.on_request(request(kThird, 1, 0, 2 * kChunk), store_);
  EXPECT_THAT(sender.tick(store_, at(0.0)), SizeIs(1));
  EXPECT_THAT(sender.tick(store_, at(0.99)), IsEmpty());
  const auto next = sender.tick(store_, at(1.0));
  ASSERT_THAT(next, SizeIs(1));
  EXPECT_EQ(next[0].to, kThird) << "the turn goes on from tick to tick";
  EXPECT_THAT(sender.tick(store_, at(2.0)), SizeIs(1));
  EXPECT_FALSE(sender.idle());
  EXPECT_THAT(sender.tick(store_, at(3.0)), SizeIs(1));
  EXPECT_TRUE(sender.idle());
}

TEST_F(SubmapSenderTest, AChunkThatWasSentMayBeAskedForAgainWhileOthersWait) {
  config_.bytes_per_second = config_.burst_bytes = 10'000.0;
  config_.overhead_bytes = 10'000 - kChunk;
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 2 * kChunk), store_);
  std::vector<std::uint32_t> offsets;
  for (int second = 0; second < 3; ++second) {
    for (const SubmapChunk& chunk : sender.tick(store_, at(second))) offsets.push_back(chunk.offset);
    if (second == 0) sender.on_request(request(kPeer, 0, 0, 1), store_);
  }
  EXPECT_THAT(offsets, ElementsAre(0u, kChunk, 0u));
}

TEST_F(SubmapSenderTest, AFullQueueDropsWhatIsAskedForBeyondIt) {
  config_.max_queued_chunks = 4;
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 1'000'000), store_);
  sender.on_request(request(kPeer, 1, 0, 1'000'000), store_);
  EXPECT_EQ(sender.stats().dropped, 2u);
  sender.on_request(request(kThird, 1, 0, 1), store_);
  EXPECT_EQ(sender.stats().dropped, 2u) << "another peer's";
  EXPECT_THAT(sender.tick(store_, at(0.0)), SizeIs(5));
}

TEST_F(SubmapSenderTest, ANodeWhoseNameBecameContestedIsLeftOut) {
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, 0, 1), store_);
  sender.on_request(request(kPeer, 1, 0, 1), store_);
  ASSERT_EQ(store_.put_node(testing::make_node(kSelf, 0, submaps_[0], 30.0)).value(), store::Put::kConflict);
  const auto chunks = sender.tick(store_, at(0.0));
  ASSERT_THAT(chunks, SizeIs(1));
  EXPECT_EQ(chunks[0].node, (NodeId{kSelf, 1}));
  EXPECT_EQ(sender.stats().refused, 1u);
  EXPECT_TRUE(sender.idle());
}

TEST_F(SubmapSenderTest, ARequestBeyondTheEndIsAnsweredToTheEnd) {
  SubmapSender sender(kSelf, config_);
  sender.on_request(request(kPeer, 0, kChunk, UINT32_MAX), store_);
  const auto chunks = sender.tick(store_, at(0.0));
  ASSERT_THAT(chunks, SizeIs(2));
  EXPECT_THAT(chunks[1].payload, SizeIs(100));
  EXPECT_EQ(sender.stats().refused, 0u);
}

}  // namespace
}  // namespace fleetmap::exchange
