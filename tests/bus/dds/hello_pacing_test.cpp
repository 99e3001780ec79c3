#include "bus/dds/hello_pacing.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

using std::chrono::seconds;

double s(HelloPacing::Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

constexpr std::size_t kBytes = 260;
constexpr HelloPacing::Answer kToUs{.names_us = true, .joined_before = true};
const HelloPacing::Clock::time_point kNow = HelloPacing::Clock::time_point(std::chrono::hours(1));

TEST(HelloPacing, HellosOfAFleetKeepToTheirPartOfTheRate) {
  for (const bool keys : {false, true}) {
    for (const double others : {1.0, 3.0, 19.0}) {
      const HelloPacing pacing({145e3, keys, false});
      const double bits = keys ? 8.0 * 345.0 * 1.5 : 8.0 * kBytes;
      // All robots together send one Hello in each pause of one of them, divided by their number.
      const double rate = (others + 1.0) * bits / s(pacing.pause_between(others, kBytes, kNow));
      EXPECT_NEAR(rate / 145e3, 0.85, 1e-6);
      const double spread = s(pacing.spread(others));
      EXPECT_LE(spread, 6.0);
      if (spread < 6.0) {
        EXPECT_NEAR(others * (others + 1.0) * bits / spread / 145e3, 0.43, 1e-6);
      }
    }
  }
}

TEST(HelloPacing, ARepetitionWaitsForTheAnswersOfAFleetThatStarts) {
  const HelloPacing plain({145e3, false, false}), observer({145e3, false, true});
  EXPECT_GT(plain.first_pause(19.0, 19.0), plain.first_pause(3.0, 3.0));
  EXPECT_NEAR(s(plain.first_pause(0.0, 0.0)), 0.5, 1e-9);
  EXPECT_NEAR(s(observer.first_pause(19.0, 19.0)), 0.5, 1e-9);
  EXPECT_EQ(s(observer.spread(19.0)), 0.0);
  EXPECT_LT(plain.first_pause(19.0, 2.0), plain.first_pause(19.0, 19.0)) << "most are known already";
}

TEST(HelloPacing, ALargeHelloTakesItsTime) {
  const HelloPacing pacing({145e3, false, false});
  EXPECT_NEAR(s(pacing.pause_between(5.0, 2 * kBytes, kNow)),
              2.0 * s(pacing.pause_between(5.0, kBytes, kNow)), 1e-8);
}

TEST(HelloPacing, OneAnswerOfARobotThatJoinedBeforeShowsAFleet) {
  HelloPacing pacing({145e3, false, false});
  EXPECT_FALSE(pacing.count_answer({.joined_before = true}, kNow)) << "answers somebody else";
  EXPECT_TRUE(pacing.count_answer({.names_us = true, .joined_before = true}, kNow));
  pacing.count_answer({.joined_before = true}, kNow);
  EXPECT_TRUE(pacing.fleet_is_connected(kNow)) << "its sender is no newcomer";
}

TEST(HelloPacing, PausesDoubleUpToTheLeastOfAnnouncementAndASecondForEachRobot) {
  const HelloPacing pacing({145e3, false, false});
  EXPECT_EQ(pacing.longer_pause(seconds(1), 19.0, seconds(100)), seconds(2));
  EXPECT_EQ(pacing.longer_pause(seconds(20), 19.0, seconds(100)), seconds(21));
  EXPECT_EQ(pacing.longer_pause(seconds(20), 19.0, seconds(10)), seconds(10));
}

TEST(HelloPacing, ANewcomerToAConnectedFleetIsFaster) {
  HelloPacing pacing({145e3, false, false});
  const auto alone = pacing.pause_between(5.0, kBytes, kNow);
  for (int answer = 0; answer < 9; ++answer)
    EXPECT_FALSE(pacing.count_answer({.names_us = true}, kNow)) << "it started together with us";
  EXPECT_TRUE(pacing.count_answer(kToUs, kNow));
  EXPECT_FALSE(pacing.count_answer(kToUs, kNow)) << "reported once";
  EXPECT_NEAR(5.0 * s(pacing.pause_between(5.0, kBytes, kNow)), s(alone), 1e-8);
  EXPECT_NEAR(2.0 * s(pacing.pause_between(5.0, kBytes, kNow + seconds(10))), s(alone), 1e-8)
      << "no newcomer any more";
  EXPECT_NEAR(s(pacing.pause_after(0, seconds(5), kNow)), HelloPacing::kNewcomerPause, 1e-9);
  EXPECT_EQ(pacing.pause_after(pacing.quick_hellos(kNow), seconds(5), kNow), seconds(5));
  const int to_a_connected_fleet = pacing.quick_hellos(kNow);
  pacing.count_answer({}, kNow);  // another newcomer
  EXPECT_LT(pacing.quick_hellos(kNow), to_a_connected_fleet);
  EXPECT_FALSE(pacing.fleet_is_connected(kNow + seconds(10)));
  EXPECT_TRUE(pacing.fleet_is_connected(kNow + seconds(11)));
  EXPECT_NEAR(2.0 * s(pacing.pause_between(5.0, kBytes, kNow + seconds(11))), s(alone), 1e-8)
      << "it is not the only one";
}

TEST(HelloPacing, HellosForTheRobotBeforeUsAreNoNewcomers) {
  HelloPacing pacing({145e3, false, false});
  pacing.count_answer(kToUs, kNow);
  pacing.count_answer({.names_another = true}, kNow);
  EXPECT_TRUE(pacing.fleet_is_connected(kNow));
}

}  // namespace
}  // namespace fleetmap::bus
