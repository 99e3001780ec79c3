#include "inertial_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::sensor {
namespace {

/// The IMU turns by 0.7 rad/s on a circle of 2 m, plus a gyro bias; no gravity.
std::vector<Imu> circle(const Eigen::Vector3d& gyro_bias, int without_from = 1000, int without_to = 0) {
  std::vector<Imu> all;
  for (int k = 0; k <= 300; ++k) {
    if (k >= without_from && k < without_to) continue;
    Imu imu;
    imu.stamp = stamp_from_ns(0) + from_seconds(0.01 * k);
    imu.angular_velocity = Eigen::Vector3d(0.0, 0.0, 0.7) + gyro_bias;
    imu.specific_force = {0.0, 2.0 * 0.7 * 0.7, 0.0};
    all.push_back(imu);
  }
  return all;
}

Stamp stamp_at(double seconds) { return stamp_from_ns(0) + from_seconds(seconds); }

TEST(InertialMotion, IntegratesACircle) {
  const Eigen::Vector3d bias(0.01, -0.02, 0.03);
  const auto motion = integrate(circle(bias), stamp_at(0.503), stamp_at(2.207), bias);
  ASSERT_TRUE(motion);
  const double angle = 0.7 * 1.704;
  EXPECT_NEAR(motion->seconds, 1.704, 1e-9);
  EXPECT_LT(so3_log(motion->R_begin_end.transpose() * so3_exp({0.0, 0.0, angle})).norm(), 1e-9);
  // Velocities are tangents of the circle, their difference is that of the forces' integral.
  const Eigen::Vector3d gained(1.4 * (std::cos(angle) - 1.0), 1.4 * std::sin(angle), 0.0);
  EXPECT_LT((motion->velocity - gained).norm(), 1e-4);
  const Eigen::Vector3d way(2.0 * std::sin(angle) - 1.4 * 1.704, 2.0 * (1.0 - std::cos(angle)), 0.0);
  EXPECT_LT((motion->displacement - way).norm(), 1e-4);
}

TEST(InertialMotion, PartsFollowOneAnother) {
  const std::vector<Imu> imu = circle(Eigen::Vector3d::Zero());
  const auto whole = integrate(imu, stamp_at(0.2), stamp_at(2.0), Eigen::Vector3d::Zero());
  const auto first = integrate(imu, stamp_at(0.2), stamp_at(1.0), Eigen::Vector3d::Zero());
  const auto second = integrate(imu, stamp_at(1.0), stamp_at(2.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(whole && first && second);
  const InertialMotion both = first->followed_by(*second);
  EXPECT_LT((both.displacement - whole->displacement).norm(), 1e-9);
  EXPECT_LT((both.displacement_by_bias - whole->displacement_by_bias).norm(), 1e-9);
  EXPECT_LT((both.velocity_by_bias - whole->velocity_by_bias).norm(), 1e-9);
}

TEST(InertialMotion, AnIntervalThatIsNotCoveredIsEmpty) {
  const std::vector<Imu> imu = circle(Eigen::Vector3d::Zero());
  EXPECT_FALSE(integrate(imu, stamp_at(-0.1), stamp_at(1.0), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(integrate(imu, stamp_at(1.0), stamp_at(3.1), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(integrate(circle(Eigen::Vector3d::Zero(), 50, 90), stamp_at(0.2), stamp_at(1.0),
                         Eigen::Vector3d::Zero()));
  EXPECT_FALSE(integrate({}, stamp_at(0.0), stamp_at(1.0), Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace fleetmap::sensor
