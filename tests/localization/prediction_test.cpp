#include "prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "localization/tracking_filter.hpp"

namespace fleetmap::localization {
namespace {

using Eigen::Vector3d;
using testing::min_eigenvalue;
using testing::tracking_filter;
using testing::wheel_at;
const Vector3d kZero = Vector3d::Zero();

Vector3d gravity() { return {0, 0, EkfConfig{}.imu.gravity}; }

TEST(Prediction, ALevelImuAtRestStaysWhereItIs) {
  Filter filter = tracking_filter();
  for (int k = 0; k < 100; ++k) predict_inertial({}, filter, 0.01, kZero, gravity(), kZero, kZero);
  EXPECT_LT(filter.p.norm(), 1e-9);
  EXPECT_LT(filter.v.norm(), 1e-9);
  EXPECT_TRUE(filter.R.isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_GT(filter.P(kPos, kPos), 0.01);
  EXPECT_GT(min_eigenvalue(filter.P), 0.0);
}

TEST(Prediction, ConstantAccelerationIsIntegratedTwice) {
  Filter filter = tracking_filter();
  filter.R = rotation_from_rpy(0, 0, 0.5 * std::numbers::pi);  // ahead is north
  for (int k = 0; k < 200; ++k)
    predict_inertial({}, filter, 0.01, kZero, gravity() + Vector3d(2, 0, 0), kZero, kZero);
  EXPECT_LT((filter.v - Vector3d(0, 4, 0)).norm(), 1e-6);
  EXPECT_LT((filter.p - Vector3d(0, 4, 0)).norm(), 1e-6);
}

TEST(Prediction, BiasesAreTakenFromWhatTheImuMeasures) {
  Filter filter = tracking_filter();
  filter.gyro_bias = {0.1, -0.2, 0.3};
  filter.accel_bias = {0.5, 0.6, -0.7};
  const Vector3d rate = filter.gyro_bias, force = gravity() + filter.accel_bias;
  for (int k = 0; k < 100; ++k) predict_inertial({}, filter, 0.01, rate, force, kZero, kZero);
  EXPECT_LT(filter.p.norm(), 1e-9);
  EXPECT_TRUE(filter.R.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
}

TEST(Prediction, AnImuAwayFromTheCentreFeelsTheTurn) {
  EkfConfig config;
  config.mounting.T_base_imu.translation() = Vector3d(0.5, 0.0, 0.0);
  Filter filter = tracking_filter();
  const Vector3d rate(0, 0, 2.0);
  const Vector3d centripetal(-2.0 * 2.0 * 0.5, 0, 0);
  for (int k = 0; k < 100; ++k)
    predict_inertial(config, filter, 0.01, rate, gravity() + centripetal, kZero, kZero);
  EXPECT_LT(filter.v.norm(), 1e-9);  // base_link turns on the spot
  EXPECT_NEAR(yaw_of(filter.R), 2.0, 1e-9);
  EXPECT_NEAR(filter.yaw_turned, 2.0, 1e-9);
}

TEST(Prediction, SamplesThatDifferAddUncertainty) {
  Filter steady = tracking_filter(), shaken = tracking_filter();
  predict_inertial({}, steady, 0.1, kZero, gravity(), kZero, kZero);
  predict_inertial({}, shaken, 0.1, kZero, gravity(), Vector3d(1, 0, 0), Vector3d(0, 5, 0));
  EXPECT_GT(shaken.P(kAtt, kAtt), steady.P(kAtt, kAtt));
  EXPECT_GT(shaken.P(kVel, kVel), steady.P(kVel, kVel));
}

TEST(Prediction, ThePositionIsHeldWhileTheHeadingIsUnknown) {
  Filter filter = tracking_filter();
  filter.phase = Phase::kCoarse;
  filter.last_wheel = wheel_at(filter.stamp, -2.0);
  predict_inertial({}, filter, 1.0, kZero, gravity() + Vector3d(3, 0, 0), kZero, kZero);
  EXPECT_EQ(filter.p, kZero);
  EXPECT_NEAR(std::sqrt(filter.P(kPos, kPos)), 0.1 + 2.0, 1e-9);  // driven somewhere
}

TEST(Prediction, TheSlowErrorOfGpsFadesToItsPrior) {
  EkfConfig config;
  Filter filter = tracking_filter();
  filter.gps_error = Vector3d(1, 2, 3);
  predict_inertial(config, filter, config.gps.correlation_time, kZero, gravity(), kZero, kZero);
  EXPECT_NEAR(filter.gps_error.z(), 3.0 / std::numbers::e, 1e-9);
  for (int k = 0; k < 20; ++k) predict_by_motion_model(config, filter, config.gps.correlation_time);
  EXPECT_NEAR(filter.P(kGpsError, kGpsError), 1.0, 1e-6);
  config.gps.correlation_time = 0.0;
  filter = tracking_filter();
  filter.gps_error = Vector3d(1, 2, 3);
  predict_by_motion_model(config, filter, 1.0);
  EXPECT_EQ(filter.gps_error, Vector3d(1, 2, 3));
}

TEST(Prediction, TheMotionModelDrivesACircleByTheWheels) {
  Filter filter = tracking_filter();
  filter.v = Vector3d(2, 0, 0);
  const double rate = 0.5;
  for (int k = 0; k < 200; ++k) {
    filter.last_wheel = wheel_at(filter.stamp, 2.0, rate);
    predict_by_motion_model({}, filter, 0.01);
  }
  const double radius = 2.0 / rate, angle = rate * 2.0;
  EXPECT_NEAR(yaw_of(filter.R), angle, 1e-9);
  EXPECT_LT((filter.p - radius * Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0)).norm(), 1e-3);
  EXPECT_NEAR(filter.v.norm(), 2.0, 1e-9);
}

TEST(Prediction, AnUnknownTurnIsLessSureThanAMeasuredOne) {
  Filter blind = tracking_filter(), steered = tracking_filter();
  steered.last_wheel = wheel_at(steered.stamp, 0.0, 0.0);
  predict_by_motion_model({}, blind, 1.0);
  predict_by_motion_model({}, steered, 1.0);
  EXPECT_GT(blind.P(kAtt + 2, kAtt + 2), steered.P(kAtt + 2, kAtt + 2) + 0.05);
}

TEST(Prediction, SlopesLevelOutWithoutAnImu) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  filter.R = rotation_from_rpy(0.2, -0.1, 1.0);
  predict_by_motion_model(config, filter, config.motion.tilt_time);
  const Vector3d rpy = rpy_from_rotation(filter.R);
  EXPECT_NEAR(rpy.x(), 0.2 / std::numbers::e, 1e-9);
  EXPECT_NEAR(rpy.y(), -0.1 / std::numbers::e, 1e-9);
  EXPECT_NEAR(rpy.z(), 1.0, 1e-9);
  EXPECT_GT(min_eigenvalue(filter.P), 0.0);
}

TEST(Prediction, AnOldWheelSampleIsNotUsed) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  EXPECT_EQ(recent_wheel(config, filter), nullptr);
  filter.last_wheel = wheel_at(stamp_from_ns(99'500'000'000), 1.0);
  EXPECT_NE(recent_wheel(config, filter), nullptr);  // as old as wheel.timeout
  filter.last_wheel = wheel_at(stamp_from_ns(99'490'000'000), 1.0);
  EXPECT_EQ(recent_wheel(config, filter), nullptr);
}

}  // namespace
}  // namespace fleetmap::localization
