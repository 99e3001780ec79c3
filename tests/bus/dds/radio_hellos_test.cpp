// The Hellos by which robots find each other: r1 is a bus, the test plays the others on sockets of this
// machine.
#include "bus/dds/radio_hellos.hpp"

#include <gmock/gmock.h>

#include "bus/dds/lone_radio.hpp"
#include "bus/dds/udp_end.hpp"

namespace fleetmap::bus::testing {
namespace {

/// r1 has heard r2, whose messages the test sends.
class RadioHellosTest : public LoneRadio {
 protected:
  void SetUp() override {
    bus_ = &start(robot("r1"));
    hello_.link = Link::kLongRange;
    hello_.address = {127, 0, 0, 1};
    hello_.port = port(1);
    ASSERT_TRUE(run_until([&] {
      send_hello_of_r2();
      return log_.count("heard r2") == 1;
    })) << log_.text();
  }
  static std::uint16_t port(int place) {
    return static_cast<std::uint16_t>(7410 + 250 * static_cast<int>(first_test_domain()) + 2 * place);
  }
  void send(const Hello& hello, std::uint8_t participant) {
    send_to(port(0), rtps_message(encode(hello), ++sent_, participant));
  }
  void send_hello_of_r2() { send(hello_, 1); }
  /// Messages sent before have been processed once a further robot is heard.
  void expect_processed(const char* further, int place, std::uint8_t participant) {
    Hello hello = hello_;
    hello.sender = name(further);
    hello.port = port(place);
    ASSERT_TRUE(run_until([&] {
      send(hello, participant);
      return log_.count(std::string("heard ") + further) == 1;
    })) << log_.text();
  }

  DdsBus* bus_ = nullptr;
  Hello hello_ = some_hello();
  std::uint8_t sent_ = 0;
};

/// Killed and started again: one Hello of the new start is enough although the one before was just heard.
TEST_F(RadioHellosTest, ARobotThatStartsAnewAtOnceIsKnownByItsFirstHello) {
  send(hello_, 2);
  EXPECT_TRUE(run_until([&] { return log_.count("heard r2") == 2; })) << log_.text();
}

/// Somebody may only say to be at a robot's place: who goes on speaking stays known.
TEST_F(RadioHellosTest, ARobotThatGoesOnSpeakingIsNotReplaced) {
  send(hello_, 2);
  // A third robot is heard well after the claim could have been taken: time enough went by.
  Hello third = hello_;
  third.sender = name("r3");
  third.port = port(2);
  const auto begun = std::chrono::steady_clock::now();
  auto next = begun;
  ASSERT_TRUE(run_until([&] {
    const auto now = std::chrono::steady_clock::now();
    if (now < next) return false;
    next = now + std::chrono::milliseconds(100);
    send_hello_of_r2();
    if (now - begun > std::chrono::seconds(3)) send(third, 3);
    return log_.count("heard r3") == 1;
  })) << log_.text();
  EXPECT_EQ(log_.count("heard r2"), 1);
}

/// Anyone can say that a robot leaves: it must come from its own place and under its name.
TEST_F(RadioHellosTest, ARobotLeavesByItsOwnWordAlone) {
  Hello last = hello_;
  last.leaves = true;
  last.port = port(3);
  send(last, 1);
  last.port = hello_.port;
  last.sender = name("r4");
  send(last, 1);
  expect_processed("r3", 2, 3);
  EXPECT_EQ(log_.count("leaves"), 0) << log_.text();
  last.sender = hello_.sender;
  send(last, 1);
  EXPECT_TRUE(run_until([&] { return log_.count("r2 leaves") == 1; })) << log_.text();
}

TEST_F(RadioHellosTest, ARobotOfThisRobotsNameIsReportedOnce) {
  Hello namesake = hello_;
  namesake.sender = name("r1");
  namesake.port = port(3);
  send(namesake, 4);
  send(namesake, 4);
  expect_processed("r3", 2, 3);
  EXPECT_EQ(log_.count("is named r1, too"), 1) << log_.text();
  EXPECT_THAT(bus_->survey(Link::kLongRange).refused,
              ::testing::Contains(::testing::HasSubstr("is named r1, too")));
}

/// The answer names the participant that it answers, so that the other one need not answer it.
TEST_F(RadioHellosTest, AnAnswerNamesWhomItAnswers) {
  UdpEnd r5(port(5));
  Hello hello = hello_;
  hello.sender = name("r5");
  hello.port = port(5);
  ASSERT_TRUE(run_until([&] {
    send(hello, 7);
    const auto answer = r5.hello();
    return answer && answer->sender == name("r1") && answer->knows.front() == 7;
  })) << log_.text();
}

}  // namespace
}  // namespace fleetmap::bus::testing
