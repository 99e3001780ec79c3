#include "neighbour_table.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

const NodeId kNode{kMaker, 5};

SubmapDigest digest(std::vector<SeqRange> submaps, std::vector<AgentId> hears) {
  return {kPeer, std::move(submaps), std::move(hears)};
}

TEST(NeighbourTable, ARobotIsInReachUntilTheTimeoutAndHearsUsIfItsDigestNamesUs) {
  NeighbourTable table(kSelf, {});
  EXPECT_FALSE(table.in_reach(kPeer, kStart));
  table.on_heard(kPeer, kStart);
  EXPECT_TRUE(table.in_reach(kPeer, kStart + std::chrono::seconds(4)));
  EXPECT_FALSE(table.in_reach(kPeer, kStart + std::chrono::milliseconds(4001)));
  EXPECT_FALSE(table.hears_us(kPeer, kStart));
  table.on_digest(digest({}, {kMaker}), kStart);
  EXPECT_FALSE(table.hears_us(kPeer, kStart));
  table.on_digest(digest({}, {kMaker, kSelf}), kStart);
  EXPECT_TRUE(table.hears_us(kPeer, kStart));
  // After an absence its last digest is out of date.
  table.on_heard(kPeer, kStart + std::chrono::seconds(60));
  EXPECT_TRUE(table.in_reach(kPeer, kStart + std::chrono::seconds(60)));
  EXPECT_FALSE(table.hears_us(kPeer, kStart + std::chrono::seconds(60)));
}

TEST(NeighbourTable, ARobotIsNearOnceThreeOfFiveDigestsArriveThatNameUs) {
  NeighbourTable table(kSelf, {});  // a digest a second, a timeout of four
  Stamp now = kStart;
  for (int k = 0; k < 2; ++k, now += std::chrono::seconds(1)) table.on_digest(digest({}, {kSelf}), now);
  EXPECT_FALSE(table.is_near(kPeer, now));
  table.on_digest(digest({}, {kSelf}), now);
  EXPECT_TRUE(table.is_near(kPeer, now));
  // Three seconds later two of the three are older than the timeout.
  now += std::chrono::seconds(3);
  table.on_heard(kPeer, now);
  EXPECT_FALSE(table.is_near(kPeer, now));
}

TEST(NeighbourTable, AnUnknownRobotDoesNotLackASubmap) {
  NeighbourTable table(kSelf, {});
  EXPECT_FALSE(table.lacks(kPeer, kNode));
  table.on_digest(digest({{kMaker, 5, 6}}, {}), kStart);
  EXPECT_TRUE(table.holds(kPeer, kNode));
  EXPECT_FALSE(table.lacks(kPeer, kNode));
  table.on_digest(digest({}, {}), kStart + std::chrono::seconds(1));
  EXPECT_FALSE(table.holds(kPeer, kNode));
  EXPECT_TRUE(table.lacks_since(kPeer, kNode, kStart));
  EXPECT_FALSE(table.lacks_since(kPeer, kNode, kStart + std::chrono::seconds(1)));
}

TEST(NeighbourTable, ADigestWithoutRoomForAllRangesAddsToTheOnesBefore) {
  SubmapTransferConfig config;
  config.max_ranges = 1;
  NeighbourTable table(kSelf, config);
  table.on_digest(digest({{kMaker, 0, 2}}, {}), kStart);
  table.on_digest(digest({{kMaker, 5, 6}}, {}), kStart);
  EXPECT_TRUE(table.holds(kPeer, {kMaker, 1}) && table.holds(kPeer, kNode));
  table.on_digest(digest({}, {}), kStart);
  EXPECT_FALSE(table.holds(kPeer, {kMaker, 1}) || table.holds(kPeer, kNode));
}

TEST(NeighbourTable, AForgedOfferEndsOnceAPartOfTheDigestCoversIt) {
  SubmapTransferConfig config;
  config.max_ranges = 2;
  NeighbourTable table(kSelf, config);
  table.on_digest(digest({{kMaker, 0, 2}, {kMaker, 5, 6}}, {}), kStart);
  table.on_digest(digest({{kMaker, 3, 4}, {kMaker, 20, 30}}, {}), kStart);
  EXPECT_TRUE(table.holds(kPeer, {kMaker, 25}) && table.holds(kPeer, {kMaker, 3}));
  table.on_digest(digest({{kMaker, 0, 2}, {kMaker, 5, 6}}, {}), kStart);
  EXPECT_FALSE(table.holds(kPeer, {kMaker, 3}));
  table.on_digest(digest({{kMaker, 5, 6}, {kMaker, 0, 2}}, {}), kStart);
  EXPECT_FALSE(table.holds(kPeer, {kMaker, 25}));
  EXPECT_TRUE(table.holds(kPeer, {kMaker, 1}) && table.holds(kPeer, kNode));
}

TEST(NeighbourTable, ImpossibleRangesAreCountedAndIgnored) {
  NeighbourTable table(kSelf, {});
  table.on_digest(digest({{kMaker, 6, 5}, {AgentId{}, 0, 9}, {kMaker, 0, kEndOfSeqs}, {kMaker, 5, 6}}, {}),
                  kStart);
  EXPECT_EQ(table.hostile_ranges(), 3u);
  EXPECT_TRUE(table.holds(kPeer, kNode));
  EXPECT_FALSE(table.holds(kPeer, {kMaker, 4}));
}

TEST(NeighbourTable, OffersOfRobotsThatHearUsCount) {
  NeighbourTable table(kSelf, {});
  const store::SeqSet lacking({{kMaker, 0, 10}});
  table.on_digest(digest({{kMaker, 4, 20}}, {}), kStart);
  EXPECT_TRUE(table.offered(lacking, 100, kStart).empty());
  table.on_digest(digest({{kMaker, 4, 20}}, {kSelf}), kStart);
  EXPECT_EQ(table.offered(lacking, 100, kStart), store::SeqSet({{kMaker, 4, 10}}));
  EXPECT_EQ(table.offered(lacking, 2, kStart), store::SeqSet({{kMaker, 4, 6}}));
}

}  // namespace
}  // namespace fleetmap::exchange
