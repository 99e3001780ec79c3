// A robot that another one knows: r1 is a bus, the test plays r2 and r3 on sockets of this machine.
#include <gmock/gmock.h>

#include <deque>

#include "bus/dds/introductions.hpp"
#include "bus/dds/lone_radio.hpp"
#include "bus/dds/rtps_messages.hpp"
#include "bus/dds/udp_end.hpp"
#include "bus/topics.hpp"

namespace fleetmap::bus::testing {
namespace {

class IntroducedRobot : public LoneRadio {
 protected:
  void SetUp() override {
    robot_ = &start(robot("r1"));
    for (const char* name : {"fleetmap/status", "fleetmap/hold/r1"})
      handles_.push_back(robot_->subscribe(small_topic(name), [this](const Bytes&) { ++came_; }));
    for (const char* name : {"fleetmap/status", "fleetmap/hold/r2", "fleetmap/hold/r3"})
      robot_->advertise(small_topic(name));
  }
  /// The Hello of r2 introduces `robots`.
  void send_hello_of_r2(std::vector<Introduction> robots) {
    Hello hello = hello_of("r2", 2);
    hello.introduces = std::move(robots);
    send_to(own_, rtps_message(encode(hello), ++sent_, /*participant=*/2));
  }
  Hello hello_of(const char* agent, std::uint16_t place) const {
    Hello hello = some_hello();
    hello.link = Link::kLongRange;
    hello.sender = name(agent);
    hello.address = {127, 0, 0, 1};
    hello.port = static_cast<std::uint16_t>(own_ + 2 * place);
    hello.seeks = 1;
    hello.reads = {key_of(small_topic("fleetmap/status")),
                   key_of(small_topic(std::string("fleetmap/hold/") + agent))};
    return hello;
  }
  /// As r2 would introduce a robot that started with r1.
  Introduction introduction(const char* agent, std::uint16_t place) const {
    Introduction robot;
    robot.prefix = {1, 15, static_cast<std::uint8_t>(place), 4, 5, 6, 7, 8, 9, 10, 11, 12};
    robot.agent = name(agent);
    robot.address = {127, 0, 0, 1};
    robot.port = static_cast<std::uint16_t>(own_ + 2 * place);
    robot.heard_ago = std::chrono::milliseconds(500);
    return robot;
  }
  /// r1 knows r4, introduced last, and so has believed or not what else r2 said.
  void introduce_and_wait(std::vector<Introduction> robots) {
    robots.push_back(introduction("r4", 4));
    ASSERT_TRUE(run_until([&] {
      send_hello_of_r2(robots);
      return log_.count("knows r4") == 1;
    })) << log_.text();
  }

  DdsBus* robot_ = nullptr;
  std::vector<Handle> handles_;
  const std::uint16_t own_ = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  int came_ = 0;
  std::uint8_t sent_ = 0;
};

TEST_F(IntroducedRobot, IsKnownWithoutAHelloOfItsOwn) {
  introduce_and_wait({introduction("r3", 3)});
  EXPECT_EQ(log_.count("knows r3 at 127.0.0.1:" + std::to_string(own_ + 6) + " from r2"), 1);
  EXPECT_EQ(robot_->matches(small_topic("fleetmap/status")).readers, 3u) << "r2, r3, r4";
  EXPECT_EQ(robot_->matches(small_topic("fleetmap/hold/r3")).readers, 1u)
      << "its topics are r1's with its name";
  EXPECT_EQ(heard(*robot_), 1u) << "only r2 was heard";
  EXPECT_EQ(log_.count("heard r3"), 0);
}

TEST_F(IntroducedRobot, IsHeardOnceItSpeaks) {
  introduce_and_wait({introduction("r3", 3)});
  const Hello hello = hello_of("r3", 3);
  ASSERT_TRUE(run_until([&] {
    Bytes message = rtps_message(encode(hello), ++sent_);
    std::ranges::copy(introduction("r3", 3).prefix, message.begin() + 8);
    send_to(own_, message);
    return heard(*robot_) == 2;
  })) << log_.text();
  EXPECT_EQ(log_.count("heard r3"), 1);
}

/// Its data may be meant for the start of r1 before this one, so a Hello of its own is still asked for.
TEST_F(IntroducedRobot, ItsDataIsTakenBeforeItsHello) {
  UdpEnd r3(static_cast<std::uint16_t>(own_ + 6));
  introduce_and_wait({introduction("r3", 3)});
  const std::uint32_t writer = key_of(small_topic("fleetmap/status"));
  const int before = came_;
  ASSERT_TRUE(run_until([&] {
    Bytes message = rtps_message({0, 1, 0, 0, 1, 2, 3, 4}, ++sent_);
    std::ranges::copy(introduction("r3", 3).prefix, message.begin() + 8);
    // The writer's entity behind RTPS header, submessage header, offset and reader.
    constexpr std::ptrdiff_t kWriter = 20 + 4 + 4 + 4;
    for (int k = 0; k < 3; ++k)
      message[static_cast<std::size_t>(kWriter + k)] = static_cast<std::uint8_t>(writer >> (16 - 8 * k));
    send_to(own_, message);
    return came_ > before && log_.count("heard r3") == 1;
  })) << log_.text();
  const std::vector<HeardTraffic> heard = robot_->take_heard_traffic();
  const auto of_r3 = std::ranges::find(heard, name("r3"), &HeardTraffic::from);
  ASSERT_NE(of_r3, heard.end());
  EXPECT_GT(of_r3->messages, 0u);
  EXPECT_EQ(of_r3->timed, 0u) << "the message says nothing of its time";
  while (r3.hello()) {
  }
  std::optional<Hello> hello;
  ASSERT_TRUE(run_until([&] { return (hello = r3.hello()).has_value(); })) << log_.text();
  EXPECT_EQ(hello->knows, Introductions::Prefix{}) << "it names nobody, so it must be answered";
}

TEST_F(IntroducedRobot, IsIntroducedToOthersInTurn) {
  UdpEnd r5(static_cast<std::uint16_t>(own_ + 10));
  introduce_and_wait({});
  std::optional<Hello> hello;
  ASSERT_TRUE(run_until([&] {
    hello = r5.hello();
    return hello && hello->introduces.size() == 2;
  })) << log_.text();
  EXPECT_EQ(hello->sender, name("r1"));
  const auto fourth = std::ranges::find(hello->introduces, name("r4"), &Introduction::agent);
  ASSERT_NE(fourth, hello->introduces.end());
  EXPECT_EQ(fourth->prefix, introduction("r4", 4).prefix);
  EXPECT_GE(fourth->heard_ago, introduction("r4", 4).heard_ago) << "it grows old on its way";
}

/// It may take r1 for its start before.
TEST_F(IntroducedRobot, IsSentAHelloThatItMustAnswer) {
  UdpEnd r3(static_cast<std::uint16_t>(own_ + 6));
  introduce_and_wait({introduction("r3", 3)});
  while (r3.hello()) {
  }
  std::optional<Hello> hello;
  ASSERT_TRUE(run_until([&] { return (hello = r3.hello()).has_value(); })) << log_.text();
  EXPECT_EQ(hello->knows, Introductions::Prefix{}) << "it names nobody";
  EXPECT_THAT(hello->introduces, ::testing::IsEmpty()) << "whoever introduced r3 tells it whom it lacks";
}

TEST_F(IntroducedRobot, IsNotKnownOutsideOfTheConfiguration) {
  Introduction elsewhere = introduction("r3", 3);
  elsewhere.port = static_cast<std::uint16_t>(own_ + 1000);
  introduce_and_wait({elsewhere});
  EXPECT_EQ(log_.count("knows r3"), 0);
}

TEST_F(IntroducedRobot, DoesNotTakeThePlaceOrTheNameOfOneThatIsKnown) {
  introduce_and_wait({introduction("r3", 2), introduction("r1", 5)});
  EXPECT_EQ(log_.count("knows r3"), 0) << "r2 is there";
  EXPECT_EQ(log_.count("knows r1"), 0);
}

TEST_F(IntroducedRobot, IsNotKnownIfItWasHeardLongAgo) {
  Introduction old = introduction("r3", 3);
  old.heard_ago = std::chrono::seconds(11);
  introduce_and_wait({old});
  EXPECT_EQ(log_.count("knows r3"), 0);
}

TEST_F(IntroducedRobot, IsNotTakenFromARobotWithOtherTopics) {
  Hello hello = hello_of("r2", 2);
  hello.reads.pop_back();
  hello.introduces = {introduction("r3", 3)};
  ASSERT_TRUE(run_until([&] {
    send_to(own_, rtps_message(encode(hello), ++sent_, /*participant=*/2));
    return heard(*robot_) == 1;
  }));
  introduce_and_wait({});
  EXPECT_EQ(log_.count("knows r3"), 0);
}

TEST_F(IntroducedRobot, ThatLeftIsNotIntroducedAgain) {
  introduce_and_wait({introduction("r3", 3)});
  Hello last = hello_of("r3", 3);
  last.leaves = true;
  ASSERT_TRUE(run_until([&] {
    Bytes message = rtps_message(encode(last), ++sent_);
    std::ranges::copy(introduction("r3", 3).prefix, message.begin() + 8);
    send_to(own_, message);
    return log_.count("r3 leaves") == 1;
  })) << log_.text();
  ASSERT_TRUE(run_until([&] {
    send_hello_of_r2({introduction("r3", 3), introduction("r5", 5)});
    return log_.count("knows r5") == 1;
  })) << log_.text();
  EXPECT_EQ(log_.count("knows r3"), 1);
}

/// Fourteen other robots of the fleet are off, and the radio has no room for all Hellos to them.
class RobotsThatAreOff : public LoneRadio {};
TEST_F(RobotsThatAreOff, KeepNobodyFromAnAnswer) {
  const auto own = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  const auto port = [&](int k) { return static_cast<std::uint16_t>(own + 2 * k); };
  std::deque<UdpEnd> off;
  for (int k = 3; k < 16; ++k) off.emplace_back(port(k));
  UdpEnd r2(port(2));
  DdsBusConfig config = robot("r1");
  config.long_range.fleet_bits_per_second = 30e3;
  const DdsBus& bus = start(config);
  int to_silent = 0;
  const auto count = [&] {
    for (UdpEnd& place : off) {
      while (place.datagram()) ++to_silent;
    }
    return to_silent;
  };
  ASSERT_TRUE(run_until([&] { return count() >= 3; }));
  while (r2.hello()) {
  }
  Hello hello = some_hello();
  hello.link = Link::kLongRange;
  hello.sender = name("r2");
  hello.knows = {};
  hello.address = {127, 0, 0, 1};
  hello.port = port(2);
  std::uint8_t number = 0;
  ASSERT_TRUE(run_until([&] {
    if (heard(bus) == 0) send_to(own, rtps_message(encode(hello), ++number, /*participant=*/2));
    return heard(bus) == 1;
  })) << log_.text();
  count();
  to_silent = 0;
  ASSERT_TRUE(run_until([&] {
    count();
    const auto answer = r2.hello();
    return answer && answer->knows.front() == 2;
  })) << log_.text();
  EXPECT_LE(to_silent, 3);
}

/// Two messages make a pair known to each other.
TEST_F(IntroducedRobot, AnAnswerIsNotAnswered) {
  UdpEnd r2(static_cast<std::uint16_t>(own_ + 4)), r4(static_cast<std::uint16_t>(own_ + 8));
  std::optional<Hello> hello;
  ASSERT_TRUE(run_until([&] { return (hello = r2.hello()).has_value(); }));
  Hello answer = hello_of("r2", 2);
  answer.knows = r2.from;
  send_to(own_, rtps_message(encode(answer), ++sent_, /*participant=*/2));
  ASSERT_TRUE(run_until([&] { return heard(*robot_) == 1; }));
  for (int later = 0; later < 3; ++later) {
    while (r4.hello()) {
    }
    send_to(own_, rtps_message(encode(hello_of("r4", 4)), ++sent_, /*participant=*/4));
    ASSERT_TRUE(run_until([&] {
      const auto answered = r4.hello();
      return answered && answered->knows.front() == 4;
    }));
  }
  EXPECT_FALSE(r2.hello());
}

}  // namespace
}  // namespace fleetmap::bus::testing
