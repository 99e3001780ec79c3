#include "page/map_progress.hpp"

#include <gtest/gtest.h>

#include "support/robots.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using fleetmap::testing::kThird;

class MapProgressTest : public ::testing::Test {
 protected:
  static monitor::RobotNow robot_with(const AgentId& id, std::size_t nodes, std::size_t submaps,
                                      double seconds_ago = 1.0) {
    monitor::RobotNow robot;
    robot.id = id;
    robot.nodes = nodes;
    robot.submaps = submaps;
    if (id != kSelf) robot.heard = {{"long_range", seconds_ago}};
    return robot;
  }
  monitor::FleetMaps after(double seconds, const std::vector<monitor::RobotNow>& robots) {
    return progress_.add(robots, kSelf, 60.0, Stamp{from_seconds(seconds)});
  }

  MapProgress progress_;
};

TEST_F(MapProgressTest, EqualMapsNeedNoTime) {
  const auto maps = after(0, {robot_with(kSelf, 40, 40), robot_with(kPeer, 40, 40)});
  EXPECT_FALSE(maps.last);
  EXPECT_EQ(maps.seconds_to_equal, 0.0);
  EXPECT_EQ(maps.missing_submaps, 0u);
}

TEST_F(MapProgressTest, TheRobotThatNeedsLongestDecidesAndNotTheOneThatLacksMost) {
  monitor::FleetMaps maps;
  for (std::size_t s = 0; s <= 20; ++s) {
    maps = after(static_cast<double>(s), {robot_with(kSelf, 100, 100), robot_with(kPeer, 100, 10 + 2 * s),
                                          robot_with(kThird, 100, 70 + s / 2)});
  }
  EXPECT_EQ(maps.last, kThird) << "20 at 0.5 a second; r2 lacks 50 and receives 2 a second";
  EXPECT_EQ(maps.missing_submaps, 20u);
  ASSERT_TRUE(maps.seconds_to_equal);
  EXPECT_NEAR(*maps.seconds_to_equal, 40.0, 1e-9);
}

TEST_F(MapProgressTest, WithoutSubmapsThatArriveThereIsNoTime) {
  monitor::FleetMaps maps;
  for (int s = 0; s <= 20; ++s) maps = after(s, {robot_with(kSelf, 100, 100), robot_with(kPeer, 100, 10)});
  EXPECT_EQ(maps.last, kPeer);
  EXPECT_FALSE(maps.seconds_to_equal);
}

TEST_F(MapProgressTest, ARateIsNotKnownAtOnceAndIsOfTheLastMinute) {
  EXPECT_FALSE(after(0, {robot_with(kSelf, 100, 10)}).seconds_to_equal);
  EXPECT_FALSE(after(9, {robot_with(kSelf, 100, 28)}).seconds_to_equal);
  EXPECT_TRUE(after(10, {robot_with(kSelf, 100, 30)}).seconds_to_equal);
  EXPECT_FALSE(after(80, {robot_with(kSelf, 100, 30)}).seconds_to_equal) << "nothing for 70 s";
}

TEST_F(MapProgressTest, LostAndUnheardRobotsAreNamedAndNotCounted) {
  monitor::RobotNow unheard;
  unheard.id = kThird;
  const auto maps = after(0, {robot_with(kSelf, 40, 40), robot_with(kPeer, 90, 5, 61.0), unheard});
  EXPECT_FALSE(maps.last);
  EXPECT_EQ(maps.not_counted, (std::vector{kPeer, kThird}));
}

TEST_F(MapProgressTest, ALostDiskBeginsAnew) {
  monitor::FleetMaps maps;
  for (int s = 0; s <= 20; ++s) maps = after(s, {robot_with(kSelf, 100, 80)});
  for (int s = 21; s <= 40; ++s) maps = after(s, {robot_with(kSelf, 100, static_cast<std::size_t>(s - 21))});
  ASSERT_TRUE(maps.seconds_to_equal);
  EXPECT_NEAR(*maps.seconds_to_equal, 81.0, 1e-9);
}

}  // namespace
}  // namespace fleetmap::apps
