#include "fleetmap/agent/odometry_messages.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::agent {
namespace {

/// Scans 0.1 s apart, each 0.1 m further along the robot's x, which looks along the frame's y.
odometry::OdometryUpdate scan(int k) {
  odometry::OdometryUpdate update;
  update.stamp = stamp_from_ns(1'000'000'000 + 100'000'000LL * k);
  update.T_odom_base = make_pose(rotation_from_rpy(0.0, 0.0, std::numbers::pi / 2.0), {0.0, 0.1 * k, 0.0});
  update.covariance = Vector6d(1e-4, 1e-6, 1e-6, 1e-9, 1e-9, 1e-9).asDiagonal();  // along x
  update.twist = Vector6d::Zero();
  update.twist[0] = 1.0;
  return update;
}

TEST(OdometryMessages, ThePosesCovarianceIsThatOfTheWholeWayInTheAxesOfTheFrame) {
  OdometryMessages messages;
  ros_codec::OdometryMsg last;
  for (int k = 0; k <= 10; ++k) last = messages.next(scan(k), {});
  EXPECT_EQ(last.stamp, scan(10).stamp);
  EXPECT_NEAR(last.covariance(1, 1), 10 * 1e-4, 1e-6) << "along the way: the frame's y";
  EXPECT_NEAR(last.covariance(0, 0), 10 * 1e-6, 2e-6) << "across";
  EXPECT_LT(last.covariance(0, 0), 0.1 * last.covariance(1, 1));
}

TEST(OdometryMessages, TheTwistIsThatOfTheRobotWithTheCovarianceOfOneStep) {
  OdometryMessages messages;
  const ros_codec::OdometryMsg first = messages.next(scan(0), {});
  EXPECT_GE(first.twist_covariance(0, 0), 1e3) << "nothing was measured before";
  for (int k = 1; k <= 5; ++k) messages.next(scan(k), {});
  const ros_codec::OdometryMsg last = messages.next(scan(6), {});
  EXPECT_EQ(last.twist[0], 1.0);
  EXPECT_NEAR(last.twist_covariance(0, 0), 1e-4 / (0.1 * 0.1), 1e-6);
  EXPECT_NEAR(last.twist_covariance(1, 1), 1e-6 / (0.1 * 0.1), 1e-6);
}

/// The pose goes on where the odometry lost its way, by a guess as uncertain as the update states.
TEST(OdometryMessages, ALostWayAddsToTheUncertaintyAndEndsTheTwist) {
  OdometryMessages messages;
  ros_codec::OdometryMsg before;
  for (int k = 0; k <= 10; ++k) before = messages.next(scan(k), {});
  odometry::LoamCounters restarted;
  restarted.map_restarts = 1;
  odometry::OdometryUpdate guess = scan(11);
  guess.covariance = 0.25 * Matrix6d::Identity();
  const ros_codec::OdometryMsg first = messages.next(guess, restarted);
  EXPECT_NEAR(first.covariance(1, 1), before.covariance(1, 1) + 0.25, 1e-6);
  EXPECT_GE(first.twist_covariance(0, 0), 1e3);
  const ros_codec::OdometryMsg second = messages.next(scan(12), restarted);
  EXPECT_NEAR(second.twist_covariance(0, 0), 1e-4 / (0.1 * 0.1), 1e-6);
  EXPECT_GT(second.covariance(1, 1), first.covariance(1, 1));
}

}  // namespace
}  // namespace fleetmap::agent
