// cmd_vel when something goes wrong, with whole agents that drive twins in virtual time. The chassis obey
// their last command for ever.
#include <gtest/gtest.h>

#include "agent/driven_fleet.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;
using testing::DrivenFleet;
using testing::stands_from;

constexpr Duration kPromise = 300ms;

/// Expects the first zero at most kPromise after `event` and none but zeros from then until now.
void expect_stands_since(const DrivenFleet& fleet, const DrivenFleet::Robot& robot, Stamp event) {
  const Duration delay = stands_from(robot, event, fleet.now()) - event;
  EXPECT_LE(delay, kPromise) << robot.id.str() << " after " << to_seconds(delay) << " s";
  EXPECT_LT(std::abs(robot.twin->speed()), 0.01) << robot.id.str();
}

class ScansStop : public ::testing::TestWithParam<double> {};

TEST_P(ScansStop, AndTheRobotStands) {
  DrivenFleet fleet({.lidar_rate = GetParam()});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.robot().scans = false;
  const Stamp last = fleet.robot().last_scan;
  fleet.run_for(5s);
  expect_stands_since(fleet, fleet.robot(), last);
  EXPECT_EQ(fleet.robot().agent->navigator()->stop_reason(), StopReason::kNoScan);
  fleet.robot().scans = true;
  EXPECT_TRUE(fleet.run_until_driving());
}

INSTANTIATE_TEST_SUITE_P(Rates, ScansStop, ::testing::Values(5.0, 10.0));

TEST(DriveSafety, ALidarOfFiveHertzIsNoReasonToStand) {
  DrivenFleet fleet({.lidar_rate = 5.0});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.robot().commands.clear();
  fleet.run_for(3s);
  ASSERT_GE(fleet.robot().commands.size(), 14u);
  for (const auto& command : fleet.robot().commands) EXPECT_FALSE(command.zero());
}

TEST(DriveSafety, StandsWhenTheOdometryGivesNothingThoughScansCome) {
  DrivenFleet fleet({});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.robot().points = false;
  const Stamp event = fleet.now();
  fleet.run_for(3s);
  EXPECT_GT(fleet.robot().agent->perception().counters().refused_scans, 20u);
  expect_stands_since(fleet, fleet.robot(), event);
  EXPECT_EQ(fleet.robot().agent->navigator()->stop_reason(), StopReason::kNoOdometry);
}

TEST(DriveSafety, IsNotDrivenByAnOdometryThatIsTooSlow) {
  DrivenFleet fleet({.perception_time = 320ms});
  fleet.run_for(15s);
  EXPECT_GT(fleet.robot().agent->perception().odometry_counters().updates, 30u);
  EXPECT_EQ(fleet.robot().twin->odometer(), 0.0);
  DrivenFleet fast({.perception_time = 80ms});
  EXPECT_TRUE(fast.run_until_driving());
}

TEST(DriveSafety, StandsWhenNobodyTellsAnyMoreWhereItIs) {
  DrivenFleet fleet({.guided = true});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.robot().guide = false;
  const Stamp last = fleet.robot().last_guide;
  fleet.run_for(5s);
  expect_stands_since(fleet, fleet.robot(), last);
  EXPECT_EQ(fleet.robot().agent->navigator()->stop_reason(), StopReason::kNoPose);
}

TEST(DriveSafety, StandsWhenGpsAndWheelsAreGoneForTooLong) {
  DrivenFleet fleet({});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.robot().fixes = fleet.robot().wheel = false;
  const double limit = DriveGuardConfig{}.max_position_sigma;
  Stamp last_good{};
  for (int k = 0; k < 1000 && !fleet.robot().agent->navigator()->stop_reason(); ++k) {
    fleet.run_for(20ms);
    const double sigma = place::horizontal_sigma(fleet.robot().G.covariance);
    if (sigma <= limit) last_good = fleet.robot().G.stamp;
  }
  fleet.run_for(3s);
  expect_stands_since(fleet, fleet.robot(), last_good);
  EXPECT_EQ(fleet.robot().agent->navigator()->stop_reason(), StopReason::kNoPose);
}

TEST(DriveSafety, StandsBeforeTheProgramWritesItsMaps) {
  DrivenFleet fleet({});
  ASSERT_TRUE(fleet.run_until_driving());
  const Stamp event = fleet.now();
  fleet.robot().agent->halt();
  fleet.run_for(5s);
  expect_stands_since(fleet, fleet.robot(), event);
}

TEST(DriveSafety, StandsWhenTheAgentIsGone) {
  DrivenFleet fleet({});
  ASSERT_TRUE(fleet.run_until_driving());
  const Stamp event = fleet.now();
  fleet.network().finish_work(fleet.robot().id);
  fleet.robot().agent.reset();  // as by an exception that ends the program
  fleet.run_for(3s);
  expect_stands_since(fleet, fleet.robot(), event);
}

TEST(DriveSafety, AnOperatorHoldsOneRobotAndLetsItGo) {
  DrivenFleet fleet({.robots = {"r1", "r2"}});
  ASSERT_TRUE(fleet.run_until_driving());
  const Stamp event = fleet.now();
  fleet.order("r1", true);
  fleet.run_for(4s);
  expect_stands_since(fleet, fleet.robot("r1"), event);
  EXPECT_EQ(fleet.robot("r1").agent->navigator()->stop_reason(), StopReason::kHeld);
  EXPECT_FALSE(fleet.robot("r2").agent->navigator()->stop_reason());
  const auto nodes = fleet.robot("r1").agent->perception().counters().scans;
  fleet.run_for(20s);
  EXPECT_GT(fleet.robot("r1").agent->perception().counters().scans, nodes + 150) << "it goes on to see";
  EXPECT_EQ(fleet.robot("r1").agent->navigator()->status().state, messages::MissionState::kDriving)
      << "who is held is not stuck";
  EXPECT_EQ(fleet.robot("r1").agent->navigator()->status().mine, 1u) << "nor loses its row";
  const double held_at = fleet.robot("r1").twin->odometer();
  fleet.order("r1", false);
  fleet.run_for(3s);
  EXPECT_GT(fleet.robot("r1").twin->odometer(), held_at + 0.5);
}

TEST(DriveSafety, AnOperatorHoldsAllRobotsAndLetsThemGo) {
  DrivenFleet fleet({.robots = {"r1", "r2"}});
  ASSERT_TRUE(fleet.run_until_driving());
  const Stamp event = fleet.now();
  fleet.order("", true);
  fleet.run_for(4s);
  expect_stands_since(fleet, fleet.robot("r1"), event);
  expect_stands_since(fleet, fleet.robot("r2"), event);
  fleet.order("", false);
  EXPECT_TRUE(fleet.run_until_driving());
}

TEST(DriveSafety, MissedOrderIsReceivedFromOtherRobots) {
  DrivenFleet fleet({.robots = {"r1", "r2"}, .long_range_loss = 0.3});
  ASSERT_TRUE(fleet.run_until_driving());
  // Nothing reaches r2 for a while, so that it cannot hear the operator himself.
  fleet.network().add_blackout(
      {bus::Link::kLongRange, fleet.now(), fleet.now() + 3s, testing::robot_id("r2")});
  for (int k = 0; k < 10; ++k) {
    fleet.order("", true);
    fleet.run_for(200ms);
  }
  EXPECT_EQ(fleet.robot("r1").agent->navigator()->stop_reason(), StopReason::kHeld);
  EXPECT_FALSE(fleet.robot("r2").agent->navigator()->stop_reason());
  fleet.run_for(25s);
  EXPECT_EQ(fleet.robot("r2").agent->navigator()->stop_reason(), StopReason::kHeld);
}

TEST(DriveSafety, HoldRemainsAfterARestartOfTheProgram) {
  DrivenFleet fleet({});
  ASSERT_TRUE(fleet.run_until_driving());
  fleet.order("r1", true);
  fleet.run_for(2s);
  const double before = fleet.robot().twin->odometer();
  fleet.restart("r1");
  EXPECT_EQ(fleet.robot().agent->navigator()->stop_reason(), StopReason::kHeld);
  fleet.run_for(20s);
  EXPECT_LT(fleet.robot().twin->odometer() - before, 0.01);
  fleet.order("r1", false);
  EXPECT_TRUE(fleet.run_until_driving());
}

TEST(DriveSafety, AButtonOnTheRobotHoldsIt) {
  DrivenFleet fleet({.robots = {"r1", "r2"}});
  ASSERT_TRUE(fleet.run_until_driving());
  const auto press = [&](bool hold) {
    messages::HoldOrder order = fleet.order_now("r1", hold);
    order.stamp = {};  // buttons have no clock
    fleet.robot("r1").bus->publish(
        fleet_codec::topics::hold_onboard(),
        fleet_codec::encode(
            messages::Hold{testing::robot_id("button"), messages::Hold::Driving::kNoRobot, {order}}));
  };
  const Stamp event = fleet.now();
  press(true);
  fleet.run_for(4s);
  expect_stands_since(fleet, fleet.robot("r1"), event);
  EXPECT_FALSE(fleet.robot("r2").agent->navigator()->stop_reason());
  press(false);
  EXPECT_TRUE(fleet.run_until_driving());
}

}  // namespace
}  // namespace fleetmap::agent
