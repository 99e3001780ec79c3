#include "hold_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap/orders/hold_orders.hpp"
#include "store/items.hpp"
#include "support/robots.hpp"

namespace fleetmap::orders {
namespace {

using namespace std::chrono_literals;
using testing::agent;
using ::testing::Contains;
using testing::kStart;
using ::testing::SizeIs;
using Kind = HoldOrder::Kind;
using Part = std::vector<HoldOrder>;

AgentId robot(int k) { return agent(("r" + std::to_string(k)).c_str()); }
HoldOrder order_to(const AgentId& whom, Kind kind, Duration at) {
  return {kStart + at, whom, agent("operator"), kind};
}
Part orders_for(int robots) {
  Part orders{order_to({}, Kind::kHold, 1s)};
  for (int k = 1; k <= robots; ++k) orders.push_back(order_to(robot(k), Kind::kHome, 1s));
  return orders;
}

TEST(HoldParts, OrdersThatFitAreOneMessage) {
  EXPECT_THAT(hold_parts({}, robot(1), 4), SizeIs(1)) << "it tells what the robot does";
  EXPECT_EQ(hold_parts(orders_for(3), robot(1), 4), std::vector<Part>{orders_for(3)});
}

TEST(HoldParts, EachIsFullAndHasWhatTheSenderObeysAndTogetherTheyHaveAll) {
  for (int robots = 4; robots < 20; ++robots) {
    const Part orders = orders_for(robots);
    Part sent;
    for (const Part& part : hold_parts(orders, robot(3), 4)) {
      EXPECT_THAT(part, SizeIs(4)) << "of " << robots;
      EXPECT_EQ(order_for(robot(3), part), order_for(robot(3), orders));
      EXPECT_THAT(part, Contains(orders[0]));
      sent.insert(sent.end(), part.begin(), part.end());
    }
    for (const HoldOrder& one : orders) EXPECT_THAT(sent, Contains(one));
  }
}

TEST(HoldParts, AreAsLongAsLinksCarry) { EXPECT_EQ(HoldOrders::kMaxInMessage, fleet_codec::kMaxHoldOrders); }

/// Forty robots that hear each other, of which each was called home alone.
class FortyRobots : public ::testing::Test {
 protected:
  void SetUp() override {
    std::set<AgentId> all;
    for (int k = 1; k <= 40; ++k) all.insert(robot(k));
    for (const AgentId& one : all) fleet_.emplace_back(one, HoldOrders(one, all));
    for (const AgentId& one : all) hear({agent("operator"), {}, {order_to(one, Kind::kHome, 1s)}});
  }
  void hear(const Hold& hold) {
    for (auto& [id, orders] : fleet_) {
      if (id != hold.from) orders.on_hold(hold);
    }
  }
  /// Ticks of 20 ms; the messages that were sent in them.
  std::size_t messages_in(Duration time) {
    std::size_t sent = 0;
    for (const Stamp end = now_ + time; now_ < end; now_ += 20ms) {
      for (auto& [id, orders] : fleet_) {
        if (!orders.tick(now_)) continue;
        for (const Part& part : orders.parts()) {
          EXPECT_LE(part.size(), fleet_codec::kMaxHoldOrders);
          hear({id, {}, part});
          ++sent;
        }
      }
    }
    return sent;
  }
  std::vector<std::pair<AgentId, HoldOrders>> fleet_;
  Stamp now_ = kStart;
};

TEST_F(FortyRobots, FallSilentWhenAllHaveAllOrders) {
  hear({agent("operator"), {}, {order_to({}, Kind::kHold, 2s)}});
  messages_in(1s);
  for (const auto& [id, orders] : fleet_) EXPECT_TRUE(orders.in_force()->kind == Kind::kHoldHome);
  EXPECT_EQ(messages_in(5s), 0u);
  EXPECT_EQ(messages_in(10s), 2 * fleet_.size()) << "from time to time";
}

TEST_F(FortyRobots, OneThatMissedAllOrdersReceivesThem) {
  messages_in(1s);
  auto& [id, late] = fleet_.back();
  std::set<AgentId> all;
  for (const auto& [one, orders] : fleet_) all.insert(one);
  late = HoldOrders(id, all);
  messages_in(12s);
  EXPECT_EQ(late.all(), fleet_.front().second.all());
  EXPECT_THAT(late.all(), SizeIs(40));
}

}  // namespace
}  // namespace fleetmap::orders
