#include "bus/local_robot.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "bus/topics.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::agent;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kSmall, testing::kState;

/// A robot without a network: what it would transmit is kept.
class LocalRobotTest : public ::testing::Test {
 protected:
  static LocalNetworkConfig config() {
    LocalNetworkConfig config;
    config.perception_time = 10ms;
    config.background_time = 100ms;
    return config;
  }
  std::unique_ptr<LocalRobot> made() {
    return std::make_unique<LocalRobot>(events_, pool_, config(),
                                        [this](const Topic& topic, std::shared_ptr<const Bytes> cdr) {
                                          transmitted_.emplace_back(topic.name, *cdr);
                                        });
  }
  void deliver(const Topic& topic, std::uint8_t byte) {
    robot_->deliver(agent("r2"), topic, std::make_shared<const Bytes>(Bytes{byte}));
  }
  TopicStats stats_of(const Topic& topic) const {
    for (const TopicStats& stats : robot_->stats()) {
      if (stats.topic == topic.name && stats.link == topic.link) return stats;
    }
    return {};
  }

  EventQueue events_{Stamp{}};
  ThreadPool pool_{0};
  std::vector<std::pair<std::string, Bytes>> transmitted_;
  std::vector<int> heard_;
  std::unique_ptr<LocalRobot> robot_ = made();
};

TEST_F(LocalRobotTest, OwnRadioMessagesAreTransmittedAndNotReceived) {
  const Handle handle = robot_->subscribe(kSmall, [this](const Bytes& cdr) { heard_.push_back(cdr[0]); });
  robot_->publish(kSmall, {1, 2, 3});
  events_.run_until(Stamp{} + 1s);
  EXPECT_THAT(transmitted_, ElementsAre(std::pair(kSmall.name, Bytes{1, 2, 3})));
  EXPECT_THAT(heard_, IsEmpty());
  EXPECT_EQ(stats_of(kSmall).sent_messages, 1u);
  EXPECT_EQ(stats_of(kSmall).sent_bytes, 3u);
  EXPECT_EQ(stats_of(kSmall).received_messages, 0u);
}

TEST_F(LocalRobotTest, TheSenderIsKnownWhileItsMessageIsHandledAndOnARadioAlone) {
  std::vector<std::optional<AgentId>> senders;
  const auto note = [&](const Bytes&) { senders.push_back(robot_->sender()); };
  const Handle node = robot_->subscribe(kSmall, note), state = robot_->subscribe(kState, note);
  deliver(kSmall, 1);
  robot_->publish(kState, {1});
  events_.run_until(Stamp{});
  EXPECT_EQ(senders, (std::vector<std::optional<AgentId>>{agent("r2"), std::nullopt}));
  EXPECT_EQ(robot_->sender(), std::nullopt);
  EXPECT_THAT(transmitted_, IsEmpty());
}

TEST_F(LocalRobotTest, ATopicOfAnotherLinkIsAnotherTopic) {
  const Handle handle = robot_->subscribe(kSmall, [this](const Bytes& cdr) { heard_.push_back(cdr[0]); });
  Topic onboard = kSmall;
  onboard.link = Link::kShortRange;
  deliver(onboard, 1);
  EXPECT_THAT(heard_, IsEmpty());
  EXPECT_FALSE(robot_->subscribes(onboard));
  deliver(kSmall, 2);
  EXPECT_THAT(heard_, ElementsAre(2));
}

TEST_F(LocalRobotTest, SubscribesAsLongAsAHandleIsKept) {
  EXPECT_FALSE(robot_->subscribes(kSmall));
  Handle first = robot_->subscribe(kSmall, [](const Bytes&) {});
  Handle second = robot_->subscribe(kSmall, [](const Bytes&) {});
  first.reset();
  EXPECT_TRUE(robot_->subscribes(kSmall));
  Topic other = kSmall;
  other.type = "Cloud";
  EXPECT_THROW(static_cast<void>(robot_->subscribes(other)), std::logic_error);
  second.reset();
  EXPECT_FALSE(robot_->subscribes(kSmall));
}

TEST_F(LocalRobotTest, SubscribersMayComeAndGoWhileAMessageIsHandled) {
  Handle second, third;
  const Handle first = robot_->subscribe(kSmall, [&](const Bytes&) {
    heard_.push_back(1);
    second.reset();
    if (heard_.size() > 1) return;
    third = robot_->subscribe(kSmall, [this](const Bytes&) { heard_.push_back(3); });
  });
  second = robot_->subscribe(kSmall, [this](const Bytes&) { heard_.push_back(2); });
  deliver(kSmall, 0);
  EXPECT_THAT(heard_, ElementsAre(1)) << "the second was cancelled, the third came later";
  deliver(kSmall, 0);
  EXPECT_THAT(heard_, ElementsAre(1, 1, 3));
  EXPECT_EQ(stats_of(kSmall).received_messages, 2u) << "a message counts once for all subscribers";
}

TEST_F(LocalRobotTest, TimersComeAtMultiplesOfTheirPeriodAndEndInTheirOwnCallback) {
  std::vector<Stamp> ticks;
  events_.run_until(Stamp{} + 5ms);
  Handle timer;
  timer = robot_->every(20ms, [&] {
    ticks.push_back(robot_->now());
    if (ticks.size() == 3) timer.reset();
  });
  events_.run_until(Stamp{} + 1s);
  EXPECT_THAT(ticks, ElementsAre(Stamp{} + 25ms, Stamp{} + 45ms, Stamp{} + 65ms));
}

TEST_F(LocalRobotTest, LanesWorkSideBySideEachInOrder) {
  std::vector<std::pair<int, Stamp>> done;
  const auto offload = [&](Lane lane, int number) {
    EXPECT_TRUE(robot_->offload(
        lane, [this, number] { heard_.push_back(number); },
        [&, number] { done.emplace_back(number, robot_->now()); }));
  };
  offload(Lane::kBackground, 1);
  offload(Lane::kPerception, 2);
  offload(Lane::kPerception, 3);
  offload(Lane::kBackground, 4);
  EXPECT_THAT(heard_, IsEmpty()) << "the caller goes on first";
  events_.run_until(Stamp{} + 1s);
  EXPECT_THAT(heard_, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(done, ElementsAre(std::pair(2, Stamp{} + 10ms), std::pair(3, Stamp{} + 20ms),
                                std::pair(1, Stamp{} + 100ms), std::pair(4, Stamp{} + 200ms)));
}

TEST_F(LocalRobotTest, NothingOfARobotThatIsGoneHappensAnyMore) {
  const Handle timer = robot_->every(10ms, [this] { heard_.push_back(1); });
  const Handle subscription = robot_->subscribe(kState, [this](const Bytes&) { heard_.push_back(2); });
  robot_->publish(kState, {1});
  robot_->offload(
      Lane::kPerception, [this] { heard_.push_back(3); }, [this] { heard_.push_back(4); });
  robot_.reset();
  events_.run_until(Stamp{} + 1s);
  EXPECT_THAT(heard_, IsEmpty());
}

TEST_F(LocalRobotTest, DropsOfALinkCountForTheirTopic) {
  robot_->count_drop(kSmall);
  robot_->count_drop(kSmall);
  EXPECT_EQ(stats_of(kSmall).dropped_messages, 2u);
  EXPECT_EQ(stats_of(kState).dropped_messages, 0u);
}

}  // namespace
}  // namespace fleetmap::bus
