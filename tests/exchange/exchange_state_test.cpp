#include "exchange_state.hpp"

#include <gtest/gtest.h>

#include "exchange/lone_exchange.hpp"
#include "exchange/robots.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;
using messages::Hold;
using messages::ProximityMatch;

class ExchangeStateTest : public LoneExchange {};

TEST_F(ExchangeStateTest, AMessageForAnotherRobotProvesItsSenderAloneToBeThere) {
  ProximityMatch match;
  match.from = kPeer;
  match.to = kThird;
  exchange_.on_message(match, kStart);
  EXPECT_TRUE(closer_.matches.empty());
  EXPECT_EQ(closer_.heard, std::vector{kPeer});
  match.to = kSelf;
  exchange_.on_message(match, kStart);
  EXPECT_EQ(closer_.matches.size(), 1u);
}

TEST_F(ExchangeStateTest, StrangersAndEchoesAreRefusedAndAStrangerIsReportedOnce) {
  ProximityMatch match;
  match.to = kSelf;
  for (const AgentId& sender : {kStranger, kSelf, kStranger}) {
    match.from = sender;
    exchange_.on_message(match, kStart);
  }
  EXPECT_TRUE(closer_.matches.empty());
  EXPECT_TRUE(closer_.heard.empty());
  const auto strangers = taken<StrangerHeard>();
  ASSERT_FALSE(strangers.empty());
  EXPECT_EQ(std::ranges::count(strangers, kStranger, &StrangerHeard::name), 1);
  EXPECT_EQ(exchange_.stats().strangers, 3u);
}

TEST_F(ExchangeStateTest, ARobotThatUsesAnothersNameIsReportedOnceByItsOwn) {
  for (int k = 0; k < 3; ++k)
    exchange_.on_message(status_of(kPeer, false), Reach::kLongRange, kStart, kThird);
  const auto reports = taken<SenderMisbehaved>();
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].name, kPeer);
  EXPECT_EQ(reports[0].from, kThird);
  EXPECT_EQ(reports[0].kind, SenderMisbehaved::Kind::kForeignName);
  exchange_.on_message(status_of(kPeer, false), Reach::kLongRange, kStart, kPeer);
  EXPECT_TRUE(taken<SenderMisbehaved>().empty());
}

TEST_F(ExchangeStateTest, TheStatusIsSentOncePerPeriodWithWhatIsHeld) {
  const Bytes submap = random_bytes(100, 1);
  ASSERT_TRUE(exchange_.on_own_node(make_node(kSelf, 0, submap), submap, kStart));
  const auto first = sent<AgentStatus>(kStart);
  ASSERT_FALSE(first.empty());
  const auto& status = std::get<AgentStatus>(first.front().message);
  EXPECT_EQ(status.from, kSelf);
  EXPECT_EQ(status.stamp, kStart);
  EXPECT_EQ(status.nodes, 1u);
  EXPECT_EQ(status.submaps, 1u);
  const Duration period = config().status_period;
  EXPECT_TRUE(sent<AgentStatus>(kStart + period - std::chrono::seconds(1)).empty());
  EXPECT_FALSE(sent<AgentStatus>(kStart + period).empty());
  EXPECT_EQ(exchange_.statuses().at(kSelf).nodes, 1u);
}

TEST_F(ExchangeStateTest, ABusyRobotCountsUntilItSaysOtherwiseOrIsSilentForMoreThanTwoPeriods) {
  const Duration period = config().status_period;
  exchange_.on_message(status_of(kPeer, true), kStart);
  EXPECT_TRUE(exchange_.others_busy(kStart + 2 * period)) << "one lost status ends nothing";
  EXPECT_FALSE(exchange_.others_busy(kStart + 3 * period));
  exchange_.on_message(status_of(kPeer, false), kStart + period);
  EXPECT_FALSE(exchange_.others_busy(kStart + period));
  EXPECT_EQ(taken<PeerStatus>().size(), 2u);
}

TEST_F(ExchangeStateTest, CompletionIsReportedWhenItBeginsAlone) {
  EXPECT_TRUE(exchange_.complete());
  exchange_.tick(kStart);
  EXPECT_EQ(taken<MapComplete>().size(), 1u);
  exchange_.tick(kStart + std::chrono::seconds(1));
  EXPECT_TRUE(taken<MapComplete>().empty());
  // The node of a peer is known, its submap is not held.
  const graph::Node theirs = make_node(kPeer, 0, random_bytes(100, 1));
  exchange_.on_message(theirs, kStart);
  const messages::SubmapDigest digest{kPeer, {{kPeer, 0, 1}}, {kSelf}};
  exchange_.on_message(digest, kStart);
  EXPECT_FALSE(exchange_.complete());
  EXPECT_FALSE(exchange_.complete({kPeer})) << "the third robot may have it";
  EXPECT_TRUE(exchange_.complete({kPeer, kThird})) << "the robot is lost and nobody else has it";
}

/// A robot that does not hear this one can be asked for nothing.
TEST_F(ExchangeStateTest, WifiPartnerIsARobotThatHearsThisOneToo) {
  ProximityMatch match;
  match.from = kPeer;
  match.to = kThird;
  exchange_.on_message(match, Reach::kShortRange, kStart);
  EXPECT_TRUE(closer_.heard.empty());
  exchange_.on_message(messages::SubmapDigest{kPeer, {}, {kThird}}, Reach::kShortRange, kStart);
  exchange_.on_message(match, Reach::kShortRange, kStart);
  EXPECT_TRUE(closer_.heard.empty());
  exchange_.on_message(messages::SubmapDigest{kPeer, {}, {kSelf}}, Reach::kShortRange, kStart);
  exchange_.on_message(match, Reach::kShortRange, kStart);
  EXPECT_EQ(closer_.heard, std::vector{kPeer});
}

TEST_F(ExchangeStateTest, RefusalsOfAHandlerAreReportedOnceWithTheirKind) {
  messages::Digest reversed;
  reversed.from = kPeer;
  reversed.nodes = {{kPeer, 9, 3}};
  reversed.node_prints = {0};
  for (int k = 0; k < 3; ++k) exchange_.on_message(reversed, Reach::kLongRange, kStart, kPeer);
  const auto reports = taken<SenderMisbehaved>();
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].name, kPeer);
  EXPECT_EQ(reports[0].kind, SenderMisbehaved::Kind::kDigest);
}

/// Others take a robot for lost whose status waits behind its nodes.
TEST_F(ExchangeStateTest, TheStatusGoesBeforeAQueueOfNodes) {
  exchange_.on_message(status_of(kPeer, false), kStart);
  for (std::uint32_t seq = 0; seq < 300; ++seq) {
    const Bytes submap = random_bytes(20, seq);
    ASSERT_TRUE(exchange_.on_own_node(make_node(kSelf, seq, submap), submap, kStart));
  }
  std::size_t nodes = 0;
  bool status_sent = false;
  for (int tick = 0; tick < 10 && !status_sent; ++tick) {
    for (const Outgoing& outgoing : exchange_.tick(kStart + tick * std::chrono::milliseconds(100))) {
      nodes += !status_sent && std::holds_alternative<graph::Node>(outgoing.message);
      status_sent = status_sent || std::holds_alternative<AgentStatus>(outgoing.message);
    }
  }
  EXPECT_TRUE(status_sent);
  EXPECT_EQ(nodes, 0u);
}

/// A stop must not wait for the disk, nor for anything that was queued before it.
TEST_F(ExchangeStateTest, AnOrderGoesBeforeAllElse) {
  exchange_.on_message(status_of(kPeer, false), kStart);
  const Bytes submap = random_bytes(20, 1);
  ASSERT_TRUE(exchange_.on_own_node(make_node(kSelf, 0, submap), submap, kStart));
  exchange_.on_local_order(HoldOrder{{}, {}, kSelf, HoldOrder::Kind::kHold}, kStart);
  const auto out = exchange_.tick(kStart);
  const auto first_radio = std::ranges::find(out, Reach::kLongRange, &Outgoing::reach);
  ASSERT_NE(first_radio, out.end());
  EXPECT_TRUE(std::holds_alternative<Hold>(first_radio->message));
}

}  // namespace
}  // namespace fleetmap::exchange
