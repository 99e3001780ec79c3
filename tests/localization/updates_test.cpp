#include "updates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "localization/tracking_filter.hpp"
#include "prediction.hpp"

namespace fleetmap::localization {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::min_eigenvalue;
using testing::tracking_filter;
using testing::wheel_at;

TEST(Updates, AFixPullsThePositionByItsWeight) {
  EkfConfig config;
  config.gps.correlation_time = 0.0;  // white
  Filter filter = tracking_filter();
  filter.P.block<3, 3>(kPos, kPos) = Matrix3d::Identity();
  ASSERT_TRUE(update_from_position(config, filter, {2, 0, -1}, Matrix3d::Identity()));
  EXPECT_LT((filter.p - Vector3d(1, 0, -0.5)).norm(), 1e-9);
  EXPECT_NEAR(filter.P(kPos, kPos), 0.5, 1e-9);
  EXPECT_GT(min_eigenvalue(filter.P), 0.0);
}

TEST(Updates, TheSlowPartOfAFixIsNotAveragedAway) {
  EkfConfig white, slow;
  white.gps.correlation_time = 0.0;
  Filter a = tracking_filter(), b = tracking_filter();
  for (Filter* filter : {&a, &b}) {
    filter->P.block<3, 3>(kPos, kPos) = 100.0 * Matrix3d::Identity();
    filter->P.block<3, 3>(kGpsError, kGpsError) = Matrix3d::Identity();
  }
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(update_from_position(white, a, Vector3d::Zero(), 4.0 * Matrix3d::Identity()));
    ASSERT_TRUE(update_from_position(slow, b, Vector3d::Zero(), 4.0 * Matrix3d::Identity()));
  }
  EXPECT_LT(a.P(kPos, kPos), 0.03);  // 4 / 200
  EXPECT_GT(b.P(kPos, kPos), 0.9 * slow.gps.correlated_share * 4.0);
  EXPECT_GT(min_eigenvalue(b.P), -1e-12);
}

TEST(Updates, AFixBeyondTheGateChangesNothing) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  const Covariance before = filter.P;
  EXPECT_FALSE(update_from_position(config, filter, {50, 0, 0}, Matrix3d::Identity()));
  EXPECT_FALSE(update_from_position(config, filter, {std::nan(""), 0, 0}, Matrix3d::Identity()));
  EXPECT_EQ(filter.p, Vector3d::Zero());
  EXPECT_EQ(filter.P, before);
  EXPECT_TRUE(update_from_position(config, filter, {50, 0, 0}, 1e4 * Matrix3d::Identity()));
}

TEST(Updates, TheLeverArmOfTheAntennaIsTakenOut) {
  EkfConfig config;
  config.mounting.p_base_antenna = {1.0, 0.0, 2.0};
  Filter filter = tracking_filter();
  filter.R = rotation_from_rpy(0, 0, 0.5 * std::numbers::pi);
  ASSERT_TRUE(update_from_position(config, filter, {0, 1, 2}, Matrix3d::Identity()));
  EXPECT_LT(filter.p.norm(), 1e-9);
}

TEST(Updates, WheelsGiveTheSpeedAlongTheHeading) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  filter.R = rotation_from_rpy(0, 0, 0.5 * std::numbers::pi);
  filter.P.block<3, 3>(kVel, kVel) = 100.0 * Matrix3d::Identity();
  filter.v = Vector3d(1, 0, 0);  // sideways
  for (int k = 0; k < 50; ++k) update_from_wheel(config, filter, wheel_at(filter.stamp, 2.0));
  EXPECT_LT((filter.v - Vector3d(0, 2, 0)).norm(), 0.1);
  EXPECT_EQ(filter.counters.wheel_used, 50u);
}

TEST(Updates, ASlippingWheelWeighsLess) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  update_from_wheel(config, filter, wheel_at(filter.stamp, 30.0));
  EXPECT_EQ(filter.counters.wheel_downweighted, 1u);
  EXPECT_LT(filter.v.norm(), 1.0);
}

TEST(Updates, WheelsAreOnlyRememberedBeforeTracking) {
  Filter filter = tracking_filter();
  filter.phase = Phase::kCoarse;
  const Covariance before = filter.P;
  update_from_wheel({}, filter, wheel_at(filter.stamp, 2.0));
  EXPECT_EQ(filter.v, Vector3d::Zero());
  EXPECT_EQ(filter.P, before);
  ASSERT_TRUE(filter.last_wheel);
  EXPECT_EQ(filter.last_wheel->forward_speed, 2.0);
}

TEST(Updates, TheWheelsYawRateShowsTheBiasOfTheGyro) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  filter.last_imu.emplace();
  filter.last_imu->stamp = filter.stamp;
  filter.last_imu->angular_velocity = {0, 0, 0.05};
  for (int k = 0; k < 200; ++k)
    update_from_wheel(config, filter, wheel_at(filter.stamp + std::chrono::seconds(k), 0.0, 0.0));
  EXPECT_NEAR(filter.gyro_bias.z(), 0.05, 0.01);
  filter = tracking_filter();
  filter.last_imu.emplace();  // of long ago
  filter.last_imu->angular_velocity = {0, 0, 0.05};
  update_from_wheel(config, filter, wheel_at(filter.stamp, 0.0, 0.0));
  EXPECT_EQ(filter.gyro_bias.z(), 0.0);
}

TEST(Updates, NothingMovesSidewaysOrUp) {
  Filter filter = tracking_filter();
  filter.P.block<3, 3>(kVel, kVel) = 10.0 * Matrix3d::Identity();
  filter.v = Vector3d(3, 1, -1);
  for (int k = 0; k < 100; ++k) update_nonholonomic({}, filter);
  EXPECT_NEAR(filter.v.x(), 3.0, 0.2);
  EXPECT_LT(filter.v.tail<2>().norm(), 0.1);
}

TEST(Updates, GravityLevelsTheAttitude) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  filter.R = rotation_from_rpy(0.1, -0.1, 1.0);  // estimated; in truth it stands level
  sensor::Imu imu;
  imu.stamp = filter.stamp;
  imu.specific_force = {0, 0, config.imu.gravity};
  for (int k = 0; k < 500; ++k) update_from_gravity(config, filter, imu, 0.01);
  const Vector3d rpy = rpy_from_rotation(filter.R);
  EXPECT_LT(rpy.head<2>().norm(), 0.03);
  EXPECT_NEAR(rpy.z(), 1.0, 0.02);
}

TEST(Updates, AHardAccelerationHardlyTiltsTheAttitude) {
  const EkfConfig config;
  Filter calm = tracking_filter(), braking = tracking_filter();
  sensor::Imu imu;
  imu.specific_force = {0.5, 0, config.imu.gravity};
  update_from_gravity(config, calm, imu, 0.1);
  imu.specific_force = {12.0, 0, config.imu.gravity};
  update_from_gravity(config, braking, imu, 0.1);
  const double per_calm = std::abs(rpy_from_rotation(calm.R).y()) / 0.5;
  const double per_braking = std::abs(rpy_from_rotation(braking.R).y()) / 12.0;
  EXPECT_LT(per_braking, 0.2 * per_calm);
}

TEST(Updates, ALostHeadingIsUniformAndUncorrelated) {
  Filter filter = tracking_filter();
  filter.P.setConstant(0.001);
  filter.P.diagonal().setConstant(0.01);
  const Matrix3d position = filter.P.block<3, 3>(kPos, kPos);
  lose_heading({}, filter);
  EXPECT_EQ(filter.phase, Phase::kCoarse);
  EXPECT_FALSE(filter.heading_set);
  EXPECT_EQ((filter.P.block<3, 3>(kPos, kPos)), position);
  EXPECT_NEAR(filter.P(kAtt + 2, kAtt + 2), std::numbers::pi * std::numbers::pi / 3.0, 1e-12);
  EXPECT_EQ(filter.P(kPos, kVel), 0.0);
  EXPECT_EQ(filter.P(kAtt + 2, kGyroBias), 0.0);
  EXPECT_GT(min_eigenvalue(filter.P), 0.0);
}

}  // namespace
}  // namespace fleetmap::localization
