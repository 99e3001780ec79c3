#include "fleetmap/orders/hold_orders.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "store/items.hpp"
#include "support/robots.hpp"

namespace fleetmap::orders {
namespace {

using namespace std::chrono_literals;
using testing::agent;
using testing::kStart;

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
  EXPECT_TRUE(orders.give(order("", true, 1s)));
  EXPECT_TRUE(orders.held());
  EXPECT_TRUE(orders.give(order("r1", false, 2s)));
  EXPECT_FALSE(orders.held()) << "it alone was let go";
  EXPECT_TRUE(order_for(agent("r2"), orders.all())->kind == HoldOrder::Kind::kHold);
  EXPECT_TRUE(orders.give(order("r2", true, 3s)));
  EXPECT_FALSE(orders.held()) << "that was for another";
  EXPECT_TRUE(orders.give(order("", true, 4s)));
  EXPECT_TRUE(orders.held());
}

TEST(HoldOrders, OrdersMayComeInAnyOrderAndAnyNumberOfTimes) {
  const std::vector<HoldOrder> received{order("", true, 1s), order("r1", false, 2s), order("", false, 3s),
                                        order("r1", true, 4s), order("r1", false, 4s)};
  std::vector<std::size_t> turn{0, 1, 2, 3, 4};
  std::optional<std::vector<HoldOrder>> first;
  do {
    HoldOrders orders(agent("r1"), kFleet);
    for (const std::size_t k : turn) orders.give(received[k]);
    for (const std::size_t k : turn) EXPECT_FALSE(orders.give(received[k])) << "it is known";
    EXPECT_TRUE(orders.held()) << "of two at one time the one to stand";
    if (!first) first = orders.all();
    EXPECT_EQ(orders.all(), *first);
  } while (std::ranges::next_permutation(turn).found);
}

TEST(HoldOrders, AnOrderAfterAnotherReplacesItWhateverTheClock) {
  HoldOrders orders(agent("r1"), kFleet);
  orders.give(order("", true, 1h));
  HoldOrder resume = order("r1", false, 0s);
  orders.give(resume);
  EXPECT_TRUE(orders.held()) << "by its stamp it was given before";
  resume.stamp = later_than(orders.all(), kStart);
  EXPECT_TRUE(orders.give(resume));
  EXPECT_FALSE(orders.held());
}

TEST(HoldOrders, OrdersForStrangersAreIgnored) {
  HoldOrders orders(agent("r1"), kFleet);
  EXPECT_FALSE(orders.give(order("r9", true, 1s)));
  EXPECT_TRUE(orders.all().empty());
}

TEST(HoldOrders, SaferOfTwoSimultaneousOrdersIsInForce) {
  const auto at_once = [](HoldOrder::Kind kind) {
    return HoldOrder{kStart, agent("r1"), agent("operator"), kind};
  };
  const HoldOrder resume = at_once(HoldOrder::Kind::kResume), home = at_once(HoldOrder::Kind::kHome),
                  hold = at_once(HoldOrder::Kind::kHold);
  EXPECT_TRUE(replaces(hold, home) && replaces(home, resume) && replaces(hold, resume));
  EXPECT_FALSE(replaces(home, hold) || replaces(resume, home) || replaces(home, home));
  HoldOrders orders(agent("r1"), kFleet);
  orders.give(home);
  EXPECT_FALSE(orders.held()) << "it drives home";
  EXPECT_EQ(orders.in_force()->kind, HoldOrder::Kind::kHome);
}

HoldOrder order(const char* robot, HoldOrder::Kind kind, Duration at) {
  HoldOrder one = order(robot, false, at);
  one.kind = kind;
  return one;
}

class HoldOnTheWayHome : public ::testing::Test {
 protected:
  using Kind = HoldOrder::Kind;
  /// Kinds in force for robots r1, r2 and r3.
  std::vector<Kind> kinds() const {
    std::vector<Kind> all;
    for (const char* name : {"r1", "r2", "r3"}) {
      const auto in_force = order_for(agent(name), orders_.all());
      all.push_back(in_force ? in_force->kind : Kind::kResume);
    }
    return all;
  }
  HoldOrders orders_{agent("r1"), kFleet};
};

TEST_F(HoldOnTheWayHome, ResumeGoesOnWithTheCallAndASecondOneEndsIt) {
  orders_.give(order("r1", Kind::kHome, 1s));
  orders_.give(order("r1", Kind::kHold, 2s));
  EXPECT_TRUE(orders_.held());
  EXPECT_TRUE(orders_.in_force()->calls_home());
  orders_.give(order("r1", Kind::kHold, 3s));
  EXPECT_TRUE(orders_.in_force()->calls_home()) << "also when it is held twice";
  EXPECT_TRUE(orders_.give(order("r1", Kind::kResume, 4s)));
  EXPECT_EQ(orders_.in_force()->kind, Kind::kHome);
  EXPECT_FALSE(orders_.give(order("r1", Kind::kResume, 4s)))
      << "an operator repeats it until it is confirmed";
  EXPECT_EQ(orders_.in_force()->kind, Kind::kHome);
  orders_.give(order("r1", Kind::kResume, 65s));
  EXPECT_EQ(orders_.in_force()->kind, Kind::kResume);
  orders_.give(order("r1", Kind::kHold, 66s));
  orders_.give(order("r1", Kind::kResume, 67s));
  EXPECT_EQ(orders_.in_force()->kind, Kind::kResume) << "the call has ended";
}

TEST_F(HoldOnTheWayHome, OrdersForAllKeepTheCallOfOne) {
  orders_.give(order("r1", Kind::kHome, 1s));
  orders_.give(order("", Kind::kHold, 2s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHoldHome, Kind::kHold, Kind::kHold}));
  orders_.give(order("", Kind::kResume, 3s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHome, Kind::kResume, Kind::kResume}));
  EXPECT_FALSE(orders_.give(order("", Kind::kResume, 3s)));
  orders_.give(order("", Kind::kResume, 4s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHome, Kind::kResume, Kind::kResume})) << "it was renewed";
  orders_.give(order("", Kind::kResume, 65s));
  EXPECT_EQ(kinds(), (std::vector(3, Kind::kResume)));
}

TEST_F(HoldOnTheWayHome, AResumeThatIsRenewedIsTheSameOrder) {
  for (const char* whom : {"r1", ""}) {
    orders_ = HoldOrders(agent("r1"), kFleet);
    orders_.give(order(whom, Kind::kHome, 1s));
    orders_.give(order(whom, Kind::kHold, 2s));
    for (const Duration at : {3s, 4s, 63s, 123s}) {
      EXPECT_TRUE(orders_.give(order(whom, Kind::kResume, at))) << "the operator waits for its stamp";
      EXPECT_EQ(orders_.in_force()->kind, Kind::kHome);
      EXPECT_EQ(orders_.in_force()->stamp, kStart + at);
    }
    orders_.give(order(whom, Kind::kResume, 123s + HoldOrders::kSameResume + 1ns));
    EXPECT_EQ(orders_.in_force()->kind, Kind::kResume) << "it is a second one";
  }
}

TEST_F(HoldOnTheWayHome, ACallOfItsOwnEndsWithTheFirstResume) {
  orders_.give(order("r1", Kind::kHome, 1s));
  orders_.give(order("r1", Kind::kHold, 2s));
  orders_.give(order("r1", Kind::kResume, 3s));
  orders_.give(order("r1", Kind::kHome, 4s));
  orders_.give(order("r1", Kind::kResume, 5s));
  EXPECT_EQ(orders_.in_force()->kind, Kind::kResume) << "it was called again, not resumed twice";
}

TEST_F(HoldOnTheWayHome, OneThatWasLetGoIsNotCalledAgain) {
  orders_.give(order("", Kind::kHome, 1s));
  orders_.give(order("r2", Kind::kResume, 2s));
  orders_.give(order("r3", Kind::kHold, 3s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHome, Kind::kResume, Kind::kHoldHome}));
  orders_.give(order("", Kind::kHold, 4s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHoldHome, Kind::kHold, Kind::kHoldHome}));
  orders_.give(order("", Kind::kResume, 5s));
  EXPECT_EQ(kinds(), (std::vector{Kind::kHome, Kind::kResume, Kind::kHome}));
}

TEST_F(HoldOnTheWayHome, ACallLetsAHeldRobotDriveHome) {
  orders_.give(order("r1", Kind::kHold, 1s));
  orders_.give(order("r1", Kind::kHome, 2s));
  EXPECT_EQ(orders_.in_force()->kind, Kind::kHome);
}

TEST_F(HoldOnTheWayHome, RobotsThatHeardDifferentOrdersComeToAgree) {
  HoldOrders other(agent("r2"), kFleet);
  orders_.give(order("r1", Kind::kHome, 1s));  // r2 misses it
  for (HoldOrders* one : {&orders_, &other}) one->on_hold(from_operator(order("r1", Kind::kHold, 2s)));
  const auto exchange = [&] {
    other.on_hold({agent("r1"), Hold::Driving::kHeld, orders_.all()});
    orders_.on_hold({agent("r2"), Hold::Driving::kFree, other.all()});
    EXPECT_EQ(orders_.all(), other.all());
  };
  exchange();
  EXPECT_EQ(orders_.in_force()->kind, Kind::kHoldHome);
  other.on_hold(from_operator(order("r1", Kind::kResume, 3s)));  // r1 misses it
  exchange();
  EXPECT_EQ(orders_.in_force()->kind, Kind::kHome);
}

TEST_F(HoldOnTheWayHome, OrdersThatOthersRepeatKeepTheCallThatTheyDidNotHearOf) {
  HoldOrders other(agent("r2"), kFleet);
  const auto exchange = [&] {
    orders_.on_hold({agent("r2"), Hold::Driving::kFree, other.all()});
    other.on_hold({agent("r1"), Hold::Driving::kHeld, orders_.all()});
    EXPECT_EQ(kinds().front(), order_for(agent("r1"), other.all())->kind);
    return kinds().front();
  };
  // r1 is called home; r2 misses that, and alone hears what follows.
  orders_.give(order("r1", Kind::kHome, 1s));
  other.give(order("", Kind::kHold, 2s));
  EXPECT_EQ(exchange(), Kind::kHoldHome);
  EXPECT_EQ(kinds()[2], Kind::kHold) << "of others it knows no more than r2";
  other.give(order("r1", Kind::kResume, 3s));
  EXPECT_EQ(exchange(), Kind::kHome);
  other.give(order("r1", Kind::kResume, 4s));  // renewed
  EXPECT_EQ(exchange(), Kind::kHome);
  orders_.give(order("r1", Kind::kResume, 5s));  // and once more
  EXPECT_EQ(exchange(), Kind::kHome);
  other.give(order("r1", Kind::kResume, 70s));
  EXPECT_EQ(exchange(), Kind::kResume);
}

TEST_F(HoldOnTheWayHome, AResumeIsRenewedAlsoAfterARestart) {
  orders_.give(order("r1", Kind::kHome, 1s));
  orders_.give(order("r1", Kind::kHold, 2s));
  orders_.give(order("r1", Kind::kResume, 3s));
  HoldOrders again(agent("r1"), kFleet);
  again.load(orders_.encoded());
  EXPECT_EQ(again.all(), orders_.all());
  again.give(order("r1", Kind::kResume, 4s));
  EXPECT_EQ(again.in_force()->kind, Kind::kHome);
}

TEST_F(HoldOnTheWayHome, SurvivesTheStore) {
  orders_.give(order("r1", Kind::kHome, 1s));
  orders_.give(order("r1", Kind::kHold, 2s));
  HoldOrders again(agent("r1"), kFleet);
  again.load(orders_.encoded());
  again.give(order("r1", Kind::kResume, 3s));
  EXPECT_EQ(again.in_force()->kind, Kind::kHome);
}

TEST(HoldOrders, RowsAreGivenAmongMembersAndRepeatedLikeTheOthers) {
  HoldOrders orders(agent("r1"), kFleet);
  const RowOrder row{kStart, agent("r1"), agent("r2"), agent("operator"), 7};
  EXPECT_FALSE(orders.give(RowOrder{kStart, agent("r9"), {}, agent("operator"), 7}));
  EXPECT_FALSE(orders.give(RowOrder{kStart, agent("r1"), agent("r9"), agent("operator"), 7}));
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
  orders.give(order("", true, 1s));
  orders.give(HoldOrder{kStart, agent("r3"), agent("operator"), HoldOrder::Kind::kHome});
  orders.give(order("r2", false, 2s));
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

}  // namespace
}  // namespace fleetmap::orders
