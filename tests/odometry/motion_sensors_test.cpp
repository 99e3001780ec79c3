#include "motion_sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::odometry {
namespace {

Stamp stamp_at(double seconds) { return stamp_from_ns(0) + from_seconds(seconds); }

/// Gyro and wheels of a robot at a constant speed and turn rate, 100 Hz from 0 to 5 s.
MotionSensors sensors_of(double speed, double yaw_rate, double bias = 0.0) {
  MotionSensors sensors{LoamConfig{}};
  for (int k = 0; k <= 500; ++k) {
    sensor::Imu imu;
    imu.stamp = stamp_at(0.01 * k);
    imu.angular_velocity = {0.0, 0.0, yaw_rate + bias};
    sensor::Wheel wheel;
    wheel.stamp = stamp_at(0.01 * k);
    wheel.forward_speed = speed;
    EXPECT_TRUE(sensors.add(imu));
    EXPECT_TRUE(sensors.add(wheel));
  }
  return sensors;
}

TEST(MotionSensors, DeadReckoningFollowsTheArc) {
  const double speed = 1.5, rate = 0.4, seconds = 2.0;
  const auto moved = sensors_of(speed, rate).displacement(stamp_at(1.0), stamp_at(1.0 + seconds));
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->p_previous_now.x(), speed / rate * std::sin(rate * seconds), 0.03);
  EXPECT_NEAR(moved->p_previous_now.y(), speed / rate * (1.0 - std::cos(rate * seconds)), 0.04);
  EXPECT_NEAR(moved->sigma, 0.03 * speed * seconds + 0.02, 1e-9);
}

TEST(MotionSensors, DeadReckoningNeedsSamplesOfTheWholeInterval) {
  const MotionSensors sensors = sensors_of(1.0, 0.0);
  EXPECT_FALSE(sensors.displacement(stamp_at(4.0), stamp_at(7.0)));
  MotionSensors wheels_only{LoamConfig{}};
  for (int k = 0; k <= 100; ++k) wheels_only.add(sensor::Wheel{stamp_at(0.01 * k), 1.0, {}});
  EXPECT_FALSE(wheels_only.displacement(stamp_at(0.1), stamp_at(0.9)));
}

TEST(MotionSensors, MotionIsSeenByWheelsOrGyro) {
  EXPECT_FALSE(sensors_of(0.0, 0.0).moving(stamp_at(1.0), stamp_at(1.1)));
  EXPECT_TRUE(sensors_of(0.5, 0.0).moving(stamp_at(1.0), stamp_at(1.1)));
  EXPECT_TRUE(sensors_of(0.0, 0.2).moving(stamp_at(1.0), stamp_at(1.1)));
  EXPECT_FALSE(MotionSensors{LoamConfig{}}.moving(stamp_at(1.0), stamp_at(1.1)));
}

TEST(MotionSensors, TheGyrosBiasIsLearnedFromTheLidarsRotations) {
  MotionSensors sensors = sensors_of(0.0, 0.0, 0.08);
  EXPECT_TRUE(sensors.moving(stamp_at(1.0), stamp_at(1.1)));
  for (int k = 0; k < 200; ++k)
    sensors.learn_gyro_bias(stamp_at(1.0), stamp_at(1.1), Eigen::Matrix3d::Identity());
  EXPECT_FALSE(sensors.moving(stamp_at(1.0), stamp_at(1.1)));
}

TEST(MotionSensors, ThePriorUsesTheMeasuredMotion) {
  const double speed = 2.0, rate = 0.3, dt = 0.1;
  const MotionSensors sensors = sensors_of(speed, rate);
  const Matrix12d covariance = Matrix12d::Identity() * 1.0;
  const MotionPrior prior = sensors.prior({}, covariance, {stamp_at(1.0), stamp_at(1.0 + dt), dt, 0.05});
  EXPECT_TRUE(prior.has_gyro_rate());
  EXPECT_TRUE(prior.has_forward_speed());
  EXPECT_FALSE(prior.has_yaw_rate()) << "the wheels measured none";
  EXPECT_NEAR(prior.predicted().twist[0], speed, 0.1);
  EXPECT_NEAR(prior.predicted().twist[5], rate, 0.01);
  EXPECT_NEAR(so3_log(prior.predicted().T_odom_base.linear()).z(), rate * dt, 0.01);
}

/// A LiDAR over bare ground feigns a sideways motion that nothing else would end.
TEST(MotionSensors, WheelsRollForwardOnly) {
  const double speed = 1.5, dt = 0.1;
  MotionState sideways;
  sideways.twist = (Vector6d() << speed, 0.9, 0, 0, 0, 0).finished();
  const auto sideslip = [&](double yaw_rate) {
    const MotionPrior prior =
        sensors_of(speed, yaw_rate)
            .prior(sideways, Matrix12d::Identity(), {stamp_at(1.0), stamp_at(1.0 + dt), dt, 0.05});
    return prior.predicted().twist[1];
  };
  EXPECT_NEAR(sideslip(0.0), 0.0, 0.05);
  EXPECT_GT(sideslip(1.0), sideslip(0.0)) << "base_link may lie beside the axis that it turns about";
}

}  // namespace
}  // namespace fleetmap::odometry
