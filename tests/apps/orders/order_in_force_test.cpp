#include "apps/orders/order_in_force.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "bus/dds_domains.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "store/items.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;
using messages::Hold;
using messages::HoldOrder;
using messages::RowOrder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

std::unique_ptr<bus::DdsBus> bus_of(const char* name) {
  bus::DdsBusConfig config;
  config.agent = testing::agent(name);
  config.qos_directory = std::string(FLEETMAP_SOURCE_DIR) + "/qos";
  config.onboard.enabled = config.short_range.enabled = false;
  config.long_range.domain = bus::testing::first_test_domain();
  config.long_range.address = "127.0.0.1";
  config.long_range.peers = {"127.0.0.1"};
  return bus::DdsBus::create(config).value();
}

/// An operator, and r1, which answers each order by `answer`.
class OrderInForceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    robot_->advertise(fleet_codec::topics::hold());
    heard_ = robot_->subscribe(fleet_codec::topics::hold(), [this](const Bytes& cdr) {
      const Hold order = fleet_codec::decode<Hold>(cdr).value();
      received_.push_back(order);
      if (const auto reply = answer_(order))
        robot_->publish(fleet_codec::topics::hold(), fleet_codec::encode(*reply));
    });
  }
  /// r1 repeats the order and stands.
  static Hold obeyed(const Hold& order) {
    return {testing::agent("r1"), Hold::Driving::kHeld, order.orders, order.rows};
  }
  HoldOrder order() const {
    return {operator_->now(), {}, testing::agent("operator"), HoldOrder::Kind::kHold};
  }
  /// Lets both sides work until `done`; false after 20 s.
  bool work_until(const std::function<bool()>& done) {
    const bus::Handle awake =
        operator_->every(10ms, [this] { robot_->run_until([] { return false; }, 5ms); });
    return operator_->run_until(done, 20s);
  }

  std::unique_ptr<bus::DdsBus> operator_ = bus_of("operator"), robot_ = bus_of("r1");
  std::function<std::optional<Hold>(const Hold&)> answer_ = obeyed;
  std::vector<Hold> received_;
  bus::Handle heard_;
};

TEST_F(OrderInForceTest, IsSentUntilTheRobotConfirmsIt) {
  int asked = 0;
  answer_ = [&](const Hold& order) { return ++asked < 2 ? std::nullopt : std::optional(obeyed(order)); };
  const OrderInForce in_force(*operator_, {testing::agent("r1")}, order());
  EXPECT_FALSE(in_force.confirmed_by_all());
  ASSERT_TRUE(work_until([&] { return in_force.confirmed_by_all(); }));
  EXPECT_THAT(in_force.confirmed(), ElementsAre(Pair(testing::agent("r1"), Hold::Driving::kHeld)));
  EXPECT_GE(received_.size(), 2u) << "the first one had no answer";
}

TEST_F(OrderInForceTest, ALaterOrderOfAClockAheadIsReplacedByOneLaterStill) {
  const Stamp ahead = operator_->now() + 1h;
  answer_ = [&](const Hold& order) {
    Hold reply = obeyed(order);
    if (reply.orders.front().stamp <= ahead)
      reply.orders = {{ahead, {}, testing::agent("other"), HoldOrder::Kind::kResume}};
    return reply;
  };
  const OrderInForce in_force(*operator_, {testing::agent("r1")}, order());
  ASSERT_TRUE(work_until([&] { return in_force.confirmed_by_all(); }));
  EXPECT_GT(received_.back().orders.front().stamp, ahead);
}

TEST_F(OrderInForceTest, AnOperatorWhoInsistsLongerIsNotOutbidForEver) {
  std::set<Stamp> stamps;
  answer_ = [&](const Hold& order) {
    stamps.insert(order.orders.front().stamp);
    const Stamp later = order.orders.front().stamp + 1s;
    return Hold{testing::agent("r1"),
                Hold::Driving::kFree,
                {{later, {}, testing::agent("other"), HoldOrder::Kind::kResume}}};
  };
  const OrderInForce in_force(*operator_, {testing::agent("r1")}, order());
  const std::size_t renewed = 4;  // the order, and three later ones
  ASSERT_TRUE(work_until([&] { return stamps.size() == renewed && received_.size() > renewed; }));
  EXPECT_EQ(stamps.size(), renewed);
  EXPECT_FALSE(in_force.confirmed_by_all());
}

TEST_F(OrderInForceTest, OnlyRobotsThatItIsAddressedToConfirmIt) {
  const OrderInForce in_force(*operator_, {testing::agent("r2")}, order());
  ASSERT_TRUE(work_until([&] { return received_.size() >= 2; }));
  EXPECT_THAT(in_force.confirmed(), IsEmpty());
}

TEST_F(OrderInForceTest, ARowIsConfirmedByTheOrderForThatRow) {
  RowOrder other{operator_->now(), testing::agent("r1"), {}, testing::agent("other"), 8};
  answer_ = [&](const Hold& order) {
    Hold reply = obeyed(order);
    if (received_.size() < 2) reply.rows = {other};
    return reply;
  };
  const RowOrder row{operator_->now(), testing::agent("r1"), {}, testing::agent("operator"), 7};
  const OrderInForce in_force(*operator_, {testing::agent("r1")}, row);
  ASSERT_TRUE(work_until([&] { return in_force.confirmed_by_all(); }));
  EXPECT_GE(received_.size(), 2u) << "an order for row 8 is none for row 7";
  EXPECT_EQ(received_.back().rows.front(), row);
}

}  // namespace
}  // namespace fleetmap::apps
