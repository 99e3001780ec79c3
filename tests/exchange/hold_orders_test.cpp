#include "fleetmap/exchange/hold_orders.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using namespace std::chrono_literals;
using testing::agent;
using testing::SimFleet;

const Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);
const std::set<AgentId> kFleet{agent("r1"), agent("r2"), agent("r3")};

HoldOrder order(const char* robot, bool hold, Duration at) {
  return {kStart + at, *robot == '\0' ? AgentId{} : agent(robot), agent("operator"),
          hold ? HoldOrder::Kind::kHold : HoldOrder::Kind::kResume};
}
Hold from_operator(const HoldOrder& order) { return {agent("operator"), Hold::Driving::kNoRobot, {order}}; }

TEST(HoldOrders, TheLatestOrderThatConcernsARobotIsInForce) {
  HoldOrders orders(agent("r1"), kFleet);
  EXPECT_FALSE(orders.in_force());
  EXPECT_FALSE(orders.held());
  EXPECT_TRUE(orders.add(order("", true, 1s)));
  EXPECT_TRUE(orders.held());
  EXPECT_TRUE(orders.add(order("r1", false, 2s)));
  EXPECT_FALSE(orders.held()) << "it alone was let go";
  EXPECT_TRUE(order_for(agent("r2"), orders.all())->kind == HoldOrder::Kind::kHold);
  EXPECT_TRUE(orders.add(order("r2", true, 3s)));
  EXPECT_FALSE(orders.held()) << "that was for another";
  EXPECT_TRUE(orders.add(order("", true, 4s)));
  EXPECT_TRUE(orders.held());
}

TEST(HoldOrders, OrdersMayComeInAnyOrderAndAnyNumberOfTimes) {
  const std::vector<HoldOrder> received{order("", true, 1s), order("r1", false, 2s), order("", false, 3s),
                                        order("r1", true, 4s), order("r1", false, 4s)};
  std::vector<std::size_t> turn{0, 1, 2, 3, 4};
  std::optional<std::vector<HoldOrder>> first;
  do {
    HoldOrders orders(agent("r1"), kFleet);
    for (const std::size_t k : turn) orders.add(received[k]);
    for (const std::size_t k : turn) EXPECT_FALSE(orders.add(received[k])) << "it is known";
    EXPECT_TRUE(orders.held()) << "of two at one time the one to stand";
    if (!first) first = orders.all();
    EXPECT_EQ(orders.all(), *first);
  } while (std::ranges::next_permutation(turn).found);
}

TEST(HoldOrders, AnOrderAfterAnotherReplacesItWhateverTheClock) {
  HoldOrders orders(agent("r1"), kFleet);
  orders.add(order("", true, 1h));
  HoldOrder resume = order("r1", false, 0s);
  orders.add(resume);
  EXPECT_TRUE(orders.held()) << "by its stamp it was given before";
  resume.stamp = later_than(orders.all(), kStart);
  EXPECT_TRUE(orders.add(resume));
  EXPECT_FALSE(orders.held());
}

TEST(HoldOrders, OrdersForStrangersAreIgnored) {
  HoldOrders orders(agent("r1"), kFleet);
  EXPECT_FALSE(orders.add(order("r9", true, 1s)));
  EXPECT_TRUE(orders.all().empty());
}

TEST(HoldOrders, OfOrdersAtOneTimeTheSaferOneIsInForce) {
  const auto at_once = [](HoldOrder::Kind kind) {
    return HoldOrder{kStart, agent("r1"), agent("operator"), kind};
  };
  const HoldOrder resume = at_once(HoldOrder::Kind::kResume), home = at_once(HoldOrder::Kind::kHome),
                  hold = at_once(HoldOrder::Kind::kHold);
  EXPECT_TRUE(replaces(hold, home) && replaces(home, resume) && replaces(hold, resume));
  EXPECT_FALSE(replaces(home, hold) || replaces(resume, home) || replaces(home, home));
  HoldOrders orders(agent("r1"), kFleet);
  orders.add(home);
  EXPECT_FALSE(orders.held()) << "it drives home";
  EXPECT_EQ(orders.in_force()->kind, HoldOrder::Kind::kHome);
}

TEST(HoldOrders, RowsAreGivenAmongMembersAndRepeatedLikeTheOthers) {
  HoldOrders orders(agent("r1"), kFleet);
  const RowOrder row{kStart, agent("r1"), agent("r2"), agent("operator"), 7};
  EXPECT_FALSE(orders.add(RowOrder{kStart, agent("r9"), {}, agent("operator"), 7}));
  EXPECT_FALSE(orders.add(RowOrder{kStart, agent("r1"), agent("r9"), agent("operator"), 7}));
  EXPECT_FALSE(orders.tick(kStart));
  EXPECT_TRUE(orders.on_hold({agent("operator"), Hold::Driving::kNoRobot, {}, {row}}));
  EXPECT_TRUE(orders.tick(kStart + 20ms));
  EXPECT_FALSE(orders.tick(kStart + 40ms));
  EXPECT_FALSE(orders.on_hold({agent("r2"), Hold::Driving::kFree, {}, {row}}));
  EXPECT_FALSE(orders.tick(kStart + 60ms)) << "r2 has it";
  orders.on_hold({agent("r2"), Hold::Driving::kFree, {}, {}});
  EXPECT_TRUE(orders.tick(kStart + 80ms)) << "r2 lacks it";
  EXPECT_TRUE(orders.tick(kStart + 12s));
  HoldOrders again(agent("r1"), kFleet);
  again.load(orders.encoded());
  EXPECT_EQ(again.rows().all(), std::vector{row});
}

TEST(HoldOrders, SurviveTheStore) {
  HoldOrders orders(agent("r1"), kFleet);
  orders.add(order("", true, 1s));
  orders.add(HoldOrder{kStart, agent("r3"), agent("operator"), HoldOrder::Kind::kHome});
  orders.add(order("r2", false, 2s));
  HoldOrders again(agent("r1"), kFleet);
  again.load(orders.encoded());
  EXPECT_EQ(again.all(), orders.all());
  HoldOrders damaged(agent("r1"), kFleet);
  const std::string text = "12 r1\nx y z\n";
  damaged.load(Bytes(text.begin(), text.end()));
  EXPECT_TRUE(damaged.all().empty());
}

TEST(HoldOrders, NothingIsSentBeforeTheFirstOrder) {
  HoldOrders orders(agent("r1"), kFleet);
  orders.on_heard(agent("r2"), kStart);
  EXPECT_FALSE(orders.tick(kStart));
  EXPECT_FALSE(orders.tick(kStart + 1h));
}

TEST(HoldOrders, AreSentAtOnceToWhoAsksAndRepeatedForWhoMissedThem) {
  HoldOrders orders(agent("r1"), kFleet);
  orders.on_hold(from_operator(order("", true, 0s)));
  EXPECT_TRUE(orders.tick(kStart));
  EXPECT_FALSE(orders.tick(kStart + 20ms));
  orders.on_hold(from_operator(order("", true, 0s)));
  EXPECT_TRUE(orders.tick(kStart + 40ms)) << "the operator did not hear the first answer";
  orders.on_hold({agent("r2"), Hold::Driving::kHeld, {order("", true, 0s)}});
  EXPECT_FALSE(orders.tick(kStart + 60ms)) << "r2 has it";
  orders.on_hold({agent("r2"), Hold::Driving::kFree, {}});
  EXPECT_TRUE(orders.tick(kStart + 80ms)) << "r2 lacks it";
  orders.on_heard(agent("r3"), kStart + 1s);
  EXPECT_TRUE(orders.tick(kStart + 1s)) << "r3 was not heard of before";
  orders.on_heard(agent("r3"), kStart + 2s);
  EXPECT_FALSE(orders.tick(kStart + 2s));
  EXPECT_TRUE(orders.tick(kStart + 12s)) << "from time to time";
}

TEST(HoldOrders, SpreadThroughAFleetThatLosesMessagesAndOutliveARestart) {
  SimFleet fleet({"r1", "r2", "r3"}, {.loss = 0.5}, 3);
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  fleet.run_for(10s);
  const auto held = [&] {
    return fleet.all([](const SimFleet::Robot& robot) {
      const auto order = robot.exchange->hold_in_force();
      return order && order->kind == HoldOrder::Kind::kHold;
    });
  };
  HoldOrder all = order("", true, 0s);
  all.stamp = fleet.now();
  fleet.robot("r1").exchange->on_message(from_operator(all), fleet.now());
  EXPECT_FALSE(held()) << "r2 and r3 cannot have heard";
  fleet.run_for(60s, held);
  EXPECT_TRUE(held());

  fleet.kill("r2");
  fleet.start("r2");
  EXPECT_TRUE(held()) << "at once, from its store";

  fleet.forget_sent();
  fleet.run_for(60s);
  double bytes = 0.0;
  for (const auto& sent : fleet.sent()) {
    if (std::holds_alternative<Hold>(sent.outgoing.message)) bytes += static_cast<double>(sent.wire_bytes);
  }
  EXPECT_LT(bytes / 60.0, 0.01 * 18'125 * 3) << "to repeat them costs next to nothing";
  EXPECT_GT(bytes, 0.0);
}

TEST(HoldOrders, GoBeforeEverythingElse) {
  const std::vector<AgentId> peers = {agent("r2")};
  SendQueue queue({}, peers, testing::payload_size);
  for (std::uint32_t k = 0; k < 50; ++k)
    queue.push(Priority::kControl, CloudRequest{agent("r1"), agent("r2"), {agent("r2"), k}, {}});
  queue.push(Priority::kSafety, Hold{agent("r1"), Hold::Driving::kHeld, {}});
  const auto out = queue.take(kStart);
  ASSERT_FALSE(out.empty());
  EXPECT_TRUE(std::holds_alternative<Hold>(out[0].message));
}

}  // namespace
}  // namespace fleetmap::exchange
