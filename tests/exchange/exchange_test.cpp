#include "fleetmap/exchange/exchange.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/recorded_loop_closer.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;
using messages::Hold;
using messages::ProximityMatch;

const AgentId kSelf = agent("r1"), kPeer = agent("r2"), kThird = agent("r3"), kStranger = agent("x");
const Stamp kStart = stamp_from_ns(1'000'000'000'000);

AgentStatus status_of(const AgentId& robot, bool busy) {
  AgentStatus status;
  status.from = robot;
  status.busy = busy;
  return status;
}

class ExchangeTest : public ::testing::Test {
 protected:
  static ExchangeConfig config() {
    ExchangeConfig config;
    config.fleet = {kSelf, kPeer, kThird};
    config.payload_size = [](const Message&) { return std::size_t{10}; };
    return config;
  }
  Exchange make() { return std::move(Exchange::make(config(), store_, closer_, kStart).value()); }
  template <class Wanted>
  std::vector<Wanted> taken() {
    std::vector<Wanted> found;
    for (const Event& event : exchange_.take_events()) {
      if (const auto* wanted = std::get_if<Wanted>(&event)) found.push_back(*wanted);
    }
    return found;
  }
  /// Messages of one kind that a second of ticks from `from` on sends.
  template <class Wanted>
  std::vector<Outgoing> sent(Stamp from) {
    std::vector<Outgoing> found;
    for (int k = 0; k < 10; ++k) {
      for (const Outgoing& outgoing : exchange_.tick(from + k * std::chrono::milliseconds(100))) {
        if (std::holds_alternative<Wanted>(outgoing.message)) found.push_back(outgoing);
      }
    }
    return found;
  }

  fleetmap::testing::ScratchFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  testing::RecordedLoopCloser closer_;
  Exchange exchange_ = make();
};

TEST_F(ExchangeTest, RefusesAConfigurationWithoutThisRobot) {
  ExchangeConfig others = config();
  others.fleet = {kPeer, kThird};
  const auto refused = Exchange::make(others, store_, closer_, kStart);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("'r1'"), std::string::npos) << refused.error().message;
}

TEST_F(ExchangeTest, AnOwnNodeIsStoredAndGoesToEachOtherRobot) {
  exchange_.on_message(status_of(kPeer, false), kStart);
  exchange_.on_message(status_of(kThird, false), kStart);
  const Bytes submap = random_bytes(100, 1);
  const graph::Node node = make_node(kSelf, 0, submap);
  EXPECT_EQ(exchange_.on_own_node(node, submap, kStart).value(), store::Put::kAdded);
  EXPECT_NE(store_.node(node.id), nullptr);
  std::set<AgentId> receivers;
  for (const Outgoing& outgoing : sent<graph::Node>(kStart)) {
    EXPECT_EQ(std::get<graph::Node>(outgoing.message).id, node.id);
    EXPECT_EQ(outgoing.reach, Reach::kLongRange);
    if (outgoing.to) receivers.insert(*outgoing.to);
  }
  EXPECT_EQ(receivers, (std::set{kPeer, kThird}));
}

TEST_F(ExchangeTest, AMessageForAnotherRobotProvesItsSenderAloneToBeThere) {
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

TEST_F(ExchangeTest, StrangersAndEchoesAreRefusedAndAStrangerIsReportedOnce) {
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

TEST_F(ExchangeTest, ARobotThatUsesAnothersNameIsReportedOnceByItsOwn) {
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

TEST_F(ExchangeTest, AnOperatorsOrderIsObeyedThoughTheOperatorIsNoMember) {
  Hold hold;
  hold.from = kStranger;
  hold.orders = {{kStart, kSelf, kStranger, true}};
  exchange_.on_message(hold, kStart);
  const auto changed = taken<HoldChanged>();
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_TRUE(changed[0].order.hold);
  exchange_.on_message(hold, kStart);
  EXPECT_TRUE(taken<HoldChanged>().empty()) << "a repetition changes nothing";
  ASSERT_TRUE(exchange_.hold_in_force());
  EXPECT_TRUE(exchange_.hold_in_force()->hold);
}

TEST_F(ExchangeTest, AnOrderSurvivesARestart) {
  exchange_.on_local_order({{}, {}, kSelf, true}, kStart);
  EXPECT_EQ(sent<Hold>(kStart).size() > 0, true) << "it goes to the others at once";
  const auto order = exchange_.hold_in_force();
  ASSERT_TRUE(order);
  EXPECT_NE(order->stamp, Stamp{});
  exchange_ = make();
  EXPECT_EQ(exchange_.hold_in_force(), order);
}

TEST_F(ExchangeTest, TheStatusIsSentOncePerPeriodWithWhatIsHeld) {
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

TEST_F(ExchangeTest, ABusyRobotCountsUntilItSaysOtherwiseOrIsSilentForMoreThanTwoPeriods) {
  const Duration period = config().status_period;
  exchange_.on_message(status_of(kPeer, true), kStart);
  EXPECT_TRUE(exchange_.others_busy(kStart + 2 * period)) << "one lost status ends nothing";
  EXPECT_FALSE(exchange_.others_busy(kStart + 3 * period));
  exchange_.on_message(status_of(kPeer, false), kStart + period);
  EXPECT_FALSE(exchange_.others_busy(kStart + period));
  EXPECT_EQ(taken<PeerStatus>().size(), 2u);
}

TEST_F(ExchangeTest, CompletionIsReportedWhenItBeginsAlone) {
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

TEST_F(ExchangeTest, ReportsWhetherEachRobotStandsByAnOrder) {
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kNoMission);
  exchange_.set_drives(true);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kFree);
  exchange_.on_local_order({{}, kSelf, kSelf, true}, kStart);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kHeld);
  exchange_.on_message(Hold{kPeer, Hold::Driving::kFree, {}}, kStart);
  EXPECT_EQ(exchange_.driving().at(kPeer), Hold::Driving::kFree);
  EXPECT_FALSE(exchange_.driving().contains(kThird));
}

TEST_F(ExchangeTest, AReportOfTheMissionBearsTheOwnName) {
  exchange_.on_message(status_of(kPeer, false), kStart);
  messages::MissionReport report;
  report.from = kThird;
  exchange_.send_report(report);
  const auto reports = sent<messages::MissionReport>(kStart);
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(std::get<messages::MissionReport>(reports.front().message).from, kSelf);
}

}  // namespace
}  // namespace fleetmap::exchange
