#include "fleetmap/exchange/exchange.hpp"

#include <gtest/gtest.h>

#include "exchange/lone_exchange.hpp"
#include "exchange/robots.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;
using messages::Hold;

class ExchangeTest : public LoneExchange {};

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

TEST_F(ExchangeTest, AnOperatorsOrderIsObeyedThoughTheOperatorIsNoMember) {
  Hold hold;
  hold.from = kStranger;
  hold.orders = {{kStart, kSelf, kStranger, HoldOrder::Kind::kHold}};
  exchange_.on_message(hold, kStart);
  const auto changed = taken<HoldChanged>();
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_EQ(changed[0].order.kind, HoldOrder::Kind::kHold);
  exchange_.on_message(hold, kStart);
  EXPECT_TRUE(taken<HoldChanged>().empty()) << "a repetition changes nothing";
  ASSERT_TRUE(exchange_.hold_in_force());
  EXPECT_EQ(exchange_.hold_in_force()->kind, HoldOrder::Kind::kHold);
}

TEST_F(ExchangeTest, AnOrderSurvivesARestart) {
  exchange_.on_local_order(HoldOrder{{}, {}, kSelf, HoldOrder::Kind::kHold}, kStart);
  EXPECT_EQ(sent<Hold>(kStart).size() > 0, true) << "it goes to the others at once";
  const auto order = exchange_.hold_in_force();
  ASSERT_TRUE(order);
  EXPECT_NE(order->stamp, Stamp{});
  exchange_ = make();
  EXPECT_EQ(exchange_.hold_in_force(), order);
}

TEST_F(ExchangeTest, RowsThatAreGivenAwayAreToldSentAndSurviveARestart) {
  exchange_.on_local_order(RowOrder{{}, kSelf, kPeer, kSelf, 7}, kStart);
  ASSERT_EQ(taken<RowsOrdered>().size(), 1u);
  ASSERT_EQ(exchange_.row_orders().size(), 1u);
  const RowOrder order = exchange_.row_orders()[0];
  EXPECT_NE(order.stamp, Stamp{});
  const auto out = sent<Hold>(kStart);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(std::get<Hold>(out[0].message).rows, std::vector{order});
  Hold back;
  back.from = kStranger;
  back.rows = {{order.stamp, kPeer, kThird, kStranger, 9}};
  exchange_.on_message(back, kStart);
  const auto told = taken<RowsOrdered>();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].orders.size(), 2u) << "all that are in force";
  exchange_.on_message(back, kStart);
  EXPECT_TRUE(taken<RowsOrdered>().empty()) << "a repetition changes nothing";
  sent<Hold>(kStart + std::chrono::seconds(1));
  exchange_ = make();
  EXPECT_EQ(exchange_.row_orders().size(), 2u);
}

TEST_F(ExchangeTest, ReportsWhetherEachRobotStandsByAnOrder) {
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kNoMission);
  exchange_.set_drives(true);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kFree);
  exchange_.on_local_order(HoldOrder{{}, kSelf, kSelf, HoldOrder::Kind::kHold}, kStart);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kHeld);
  exchange_.on_local_order(HoldOrder{{}, kSelf, kSelf, HoldOrder::Kind::kHome}, kStart);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kHome);
  exchange_.on_local_order(HoldOrder{{}, kSelf, kSelf, HoldOrder::Kind::kHold}, kStart);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kHeld);
  exchange_.on_local_order(HoldOrder{{}, kSelf, kSelf, HoldOrder::Kind::kResume}, kStart);
  EXPECT_EQ(exchange_.driving().at(kSelf), Hold::Driving::kHome) << "as before it was held";
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
