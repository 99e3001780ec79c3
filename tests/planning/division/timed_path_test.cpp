#include "fleetmap/planning/division/timed_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

TEST(TimedPath, PositionAndDistanceOverTime) {
  // 10 m, a stop of 5 s, and 10 m at half the speed.
  const TimedPath path{{{0, 0}, {10, 0}, {10, 0}, {10, 10}}, {0.0, 10.0, 15.0, 35.0}};
  EXPECT_LT((path.at(-1.0) - Vector2d(0, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(5.0) - Vector2d(5, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(12.0) - Vector2d(10, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(25.0) - Vector2d(10, 5)).norm(), 1e-12);
  EXPECT_LT((path.at(99.0) - Vector2d(10, 10)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(path.driven(5.0), 5.0);
  EXPECT_DOUBLE_EQ(path.driven(12.0), 10.0);
  EXPECT_DOUBLE_EQ(path.driven(25.0), 15.0);
  EXPECT_DOUBLE_EQ(path.driven(99.0), 20.0);
}

TEST(TimedPath, ARobotTurnsOnTheSpotAndDrivesItsRows) {
  Mission mission;
  mission.rows = {{3, {{0, 0}, {30, 0}}}, {4, {{0, 10}, {30, 10}}}};
  const RoutePlanner planner = *RoutePlanner::create(mission);
  RobotAbility robot = testing::fleet(1)[0];
  robot.start = {{0, 0}, 0.0};
  robot.speed = 2.0;
  robot.yaw_rate = 0.5;
  const std::vector<RowVisit> visits = {{3, false}, {4, true}};
  const TimedPath path = timed_path(planner, mission, robot, visits, std::nullopt);
  // 70 m at 2 m/s and two turns of 90 deg at 0.5 rad/s.
  EXPECT_NEAR(path.times.back(), 35.0 + M_PI / 0.5, 1e-6);
  EXPECT_NEAR(path.driven(1e9), 70.0, 1e-6);
  EXPECT_LT((path.points.back() - Vector2d(0, 10)).norm(), 1e-6);
  EXPECT_LT((path.at(15.0) - Vector2d(30, 0)).norm(), 1e-6);
  EXPECT_LT((path.at(15.0 + 1.0) - Vector2d(30, 0)).norm(), 1e-6);  // still turning
  const TimedPath home = timed_path(planner, mission, robot, visits, Vector2d(0, 0));
  EXPECT_NEAR(home.driven(1e9), 80.0, 1e-6);
}

}  // namespace
}  // namespace fleetmap::planning
