#include "bus/dds/introductions.hpp"

#include <gmock/gmock.h>

#include <array>

namespace fleetmap::bus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Introductions::Prefix prefix(std::uint8_t number) {
  Introductions::Prefix prefix{};
  prefix.back() = number;
  return prefix;
}

Introduction robot(std::uint8_t number, Duration heard_ago = seconds(1), Duration joined_ago = seconds(2)) {
  Introduction introduction;
  introduction.prefix = prefix(number);
  introduction.heard_ago = heard_ago;
  introduction.joined_ago = joined_ago;
  return introduction;
}

constexpr auto kNobody = Introductions::Prefix{};

std::vector<int> numbers(const std::vector<Introduction>& introductions) {
  std::vector<int> result;
  for (const Introduction& one : introductions) result.push_back(one.prefix.back());
  return result;
}

TEST(Introductions, ToAnUnknownRobotAreOfAllThatWereHeardLately) {
  const Introductions introductions;
  EXPECT_THAT(numbers(introductions.select({robot(1, seconds(3)), robot(2, seconds(11)), robot(3)}, kNobody,
                                           std::nullopt)),
              ElementsAre(3, 1));
}

TEST(Introductions, LeaveOutTheReceiverAndWhomItSaidToKnow) {
  Introductions introductions;
  introductions.note_known(prefix(1), {robot(3)});
  introductions.note_known(prefix(1), {robot(4)});
  introductions.note_known(prefix(2), {robot(5)});
  EXPECT_THAT(numbers(introductions.select({robot(1), robot(2), robot(3), robot(4), robot(5)}, prefix(1),
                                           seconds(2))),
              ElementsAre(2, 5));
}

TEST(Introductions, RobotsThatJoinedLongAgoAreNotIntroduced) {
  const Introductions introductions;
  const std::vector<Introduction> known{robot(1, seconds(1), seconds(31)), robot(2, seconds(1), seconds(29))};
  EXPECT_THAT(numbers(introductions.select(known, prefix(9), seconds(31))), ElementsAre(2));
  EXPECT_THAT(numbers(introductions.select(known, prefix(9), seconds(29))), ElementsAre(1, 2));
  EXPECT_THAT(numbers(introductions.select(known, kNobody, std::nullopt)), ElementsAre(1, 2));
}

TEST(Introductions, FitIntoAHello) {
  const Introductions introductions;
  std::vector<Introduction> known;
  for (std::uint8_t i = 1; i <= 50; ++i) known.push_back(robot(i, milliseconds(100 * (51 - i))));
  const auto chosen = introductions.select(known, kNobody, std::nullopt);
  ASSERT_EQ(chosen.size(), kMaxIntroductions);
  EXPECT_EQ(chosen.front().prefix.back(), 50) << "the one heard last";
  Hello hello;
  hello.sender = AgentId::parse("r1").value();
  hello.port = 7410;
  hello.reads.resize(16);
  hello.introduces = chosen;
  for (Introduction& one : hello.introduces) {
    one.agent = AgentId::parse("r2").value();
    one.port = 7410;
  }
  EXPECT_LT(encode(hello).size(), 1280u) << "one IP packet";
}

TEST(Introductions, RobotThatLeftIsIntroducedOnlyAfterItsOwnHello) {
  Introductions introductions;
  EXPECT_TRUE(introductions.accepts(robot(1)));
  EXPECT_FALSE(introductions.accepts(robot(1, seconds(11))));
  introductions.forget(prefix(1));
  EXPECT_FALSE(introductions.accepts(robot(1)));
  EXPECT_TRUE(introductions.accepts(robot(2)));
  introductions.meet(prefix(1));
  EXPECT_TRUE(introductions.accepts(robot(1)));
}

TEST(Introductions, RememberABoundedNumberOfRobots) {
  Introductions introductions;
  for (int i = 0; i < 300; ++i) {
    Introductions::Prefix gone{};
    gone[0] = static_cast<std::uint8_t>(i / 256 + 1);
    gone[1] = static_cast<std::uint8_t>(i);
    introductions.forget(gone);
  }
  Introduction first = robot(0);
  first.prefix = {1};
  EXPECT_TRUE(introductions.accepts(first)) << "forgotten long ago";
}

TEST(Introductions, TravelInAHello) {
  Introduction one = robot(7, milliseconds(1234), seconds(300));
  one.prefix = {1, 15, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  one.agent = AgentId::parse("r12").value();
  one.address = {10, 0, 0, 12};
  one.port = 7660;
  Hello hello;
  hello.sender = AgentId::parse("r1").value();
  hello.port = 7410;
  hello.joined_ago = seconds(8);
  hello.seeks = 3;
  hello.introduces = {one};
  const auto decoded = decode_hello(encode(hello));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->joined_ago, seconds(8));
  EXPECT_EQ(decoded->seeks, 3);
  one.heard_ago = milliseconds(1200);
  one.joined_ago = seconds(255);
  EXPECT_THAT(decoded->introduces, ElementsAre(one));
  hello.introduces.front().port = 0;
  EXPECT_THAT(decode_hello(encode(hello))->introduces, IsEmpty()) << "no robot can be there";
}

}  // namespace
}  // namespace fleetmap::bus
