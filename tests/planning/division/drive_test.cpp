#include "division/drive.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

constexpr double kRight = 0.5 * std::numbers::pi;

RobotAbility slow_robot() {
  RobotAbility robot = testing::fleet(1)[0];
  robot.speed = 2.0;
  robot.yaw_rate = 0.5;
  return robot;
}

TEST(Drive, TurnsOnTheSpotAndThenDrives) {
  const RobotAbility robot = slow_robot();
  Drive drive(robot, {{0, 0}, 0.0});
  EXPECT_EQ(drive.path().points.size(), 1u);
  drive.add({{0, 0}, {10, 0}});
  EXPECT_NEAR(drive.path().times.back(), 5.0, 1e-12) << "it stands in this direction";
  drive.add({{10, 10}});
  EXPECT_NEAR(drive.path().times.back(), 5.0 + kRight / 0.5 + 5.0, 1e-12);
  EXPECT_EQ(drive.path().at(5.0 + 0.9 * kRight / 0.5), Vector2d(10, 0));
  EXPECT_EQ(drive.pose().position, Vector2d(10, 10));
  EXPECT_NEAR(drive.pose().yaw, kRight, 1e-12);
  ASSERT_EQ(drive.path().times.size(), drive.path().points.size());
}

TEST(Drive, TurnsTheShorterWay) {
  const RobotAbility robot = slow_robot();
  const double tenth = 0.1;  // rad
  Drive drive(robot, {{0, 0}, std::numbers::pi - tenth});
  drive.add({Vector2d(-std::cos(tenth), -std::sin(tenth))});  // to -pi + 0.1
  EXPECT_NEAR(drive.path().times.back(), 2.0 * tenth / 0.5 + 1.0 / 2.0, 1e-9);
}

TEST(Drive, PointsInOnePlaceCostNothing) {
  const RobotAbility robot = slow_robot();
  Drive drive(robot, {{3, 4}, 1.0});
  drive.add({{3, 4}, {3.0005, 4}, {3, 4.0005}});
  drive.add({});
  EXPECT_EQ(drive.path().points.size(), 1u);
  EXPECT_EQ(drive.path().times.back(), 0.0);
  EXPECT_EQ(drive.pose().yaw, 1.0);
}

/// Two rows beside a block of 40 m x 40 m.
Mission mission_with_a_block() {
  Mission mission;
  mission.rows = {{7, {{0, 0}, {30, 0}}}, {9, {{0, 60}, {30, 60}}}};
  mission.keep_out = {{{-5, 10}, {35, 10}, {35, 50}, {-5, 50}}};
  return mission;
}

TEST(Drive, ARowIsDrivenInTheDirectionOfTheVisit) {
  const Mission mission = mission_with_a_block();
  const RoutePlanner planner = *RoutePlanner::create(mission);
  const RobotAbility robot = slow_robot();
  for (const bool reversed : {false, true}) {
    Drive drive(robot, {{0, -20}, 0.0});
    drive.add_row(planner, mission, {7, reversed});
    const Vector2d begin(reversed ? 30 : 0, 0), end(reversed ? 0 : 30, 0);
    EXPECT_LT((drive.pose().position - end).norm(), 1e-6);
    EXPECT_LT((drive.path().at(drive.path().times.back() - 15.0) - begin).norm(), 1e-6) << "30 m before";
    EXPECT_NEAR(drive.path().driven(1e9), (begin - Vector2d(0, -20)).norm() + 30.0, 1e-6);
  }
}

TEST(Drive, WaysLeadAroundWhatIsInTheWay) {
  const Mission mission = mission_with_a_block();
  const RoutePlanner planner = *RoutePlanner::create(mission);
  const RobotAbility robot = slow_robot();
  Drive drive(robot, {{15, 0}, 0.0});
  drive.add_way(planner, {15, 60});
  EXPECT_LT((drive.pose().position - Vector2d(15, 60)).norm(), 1e-6);
  const double around = 2.0 * Vector2d(20, 10).norm() + 40.0;  // past the corners of one side
  EXPECT_GT(drive.path().driven(1e9), around);
  EXPECT_LT(drive.path().driven(1e9), 1.1 * around);
  for (double time = 0.0; time < drive.path().times.back(); time += 0.5)
    EXPECT_TRUE(planner.clear(drive.path().at(time))) << time;
}

TEST(Drive, StaysWhereItIsIfThereIsNoWay) {
  const Mission mission = mission_with_a_block();
  const RoutePlanner planner = *RoutePlanner::create(mission);
  const RobotAbility robot = slow_robot();
  Drive drive(robot, {{0, 0}, 0.3});
  drive.add_way(planner, {15, 30});  // in the middle of the block
  EXPECT_EQ(drive.path().points.size(), 1u);
  EXPECT_EQ(drive.pose().position, Vector2d(0, 0));
  EXPECT_EQ(drive.pose().yaw, 0.3);
}

}  // namespace
}  // namespace fleetmap::planning
