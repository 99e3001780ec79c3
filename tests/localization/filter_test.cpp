#include "fleetmap/localization/filter.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "localization/tracking_filter.hpp"
#include "prediction.hpp"

namespace fleetmap::localization {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::tracking_filter;
using testing::wheel_at;

const LocalFrame& site() {
  static const LocalFrame frame(geo_point_from_degrees(49.0, 8.4, 100.0));
  return frame;
}

Stamp at(double seconds) { return Stamp{} + from_seconds(100.0 + seconds); }

sensor::Fix fix_at(double seconds, const Vector3d& p_enu, double sigma = 1.0) {
  sensor::Fix fix;
  fix.stamp = at(seconds);
  fix.position = site().to_geo(p_enu);
  fix.covariance = sigma * sigma * Matrix3d::Identity();
  return fix;
}

/// At rest, with this attitude, turning about its z axis.
sensor::Imu imu_at(double seconds, const Matrix3d& R = Matrix3d::Identity(), double rate = 0.0) {
  sensor::Imu imu;
  imu.stamp = at(seconds);
  imu.specific_force = R.transpose() * Vector3d(0, 0, ImuModel{}.gravity);
  imu.angular_velocity = {0, 0, rate};
  return imu;
}

sensor::Imu oriented(double seconds, const Matrix3d& R, double yaw_variance) {
  sensor::Imu imu = imu_at(seconds, R);
  imu.q_enu_imu = Eigen::Quaterniond(R);
  imu.orientation_variance.z() = yaw_variance;
  return imu;
}

/// Has a position and no heading at 3 s.
Filter coarse_filter(const EkfConfig& config) {
  Filter filter;
  for (const double t : {1.0, 2.0, 3.0}) apply(config, filter, fix_at(t, Vector3d::Zero()));
  return filter;
}

TEST(Filter, TheFirstSampleStartsItWithAllOpen) {
  const EkfConfig config;
  Filter filter;
  const sensor::Wheel wheel = wheel_at(at(5.0), 2.0);
  EXPECT_EQ(stamp_of(wheel), at(5.0));
  apply(config, filter, wheel);
  EXPECT_TRUE(filter.started);
  EXPECT_EQ(filter.stamp, at(5.0));
  EXPECT_EQ(filter.phase, Phase::kWaiting);
  EXPECT_EQ(filter.v, Vector3d::Zero());
  EXPECT_DOUBLE_EQ(filter.P(kVel, kVel), 9.0);
  EXPECT_NEAR(filter.P(kAtt + 2, kAtt + 2), std::numbers::pi * std::numbers::pi / 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(filter.P(kGpsError, kGpsError), 1.0);
}

TEST(Filter, FixesThatAgreeBeginThePosition) {
  const EkfConfig config;
  Filter filter;
  apply(config, filter, fix_at(1.0, {0, 0, 0}, 2.0));
  apply(config, filter, fix_at(2.0, {5000, 0, 0}, 2.0));  // no robot is so fast
  apply(config, filter, fix_at(3.0, {5000, 0, 0}, 2.0));
  sensor::Fix invalid = fix_at(3.5, {5000, 0, 0}, 2.0);
  invalid.valid = false;
  apply(config, filter, invalid);
  EXPECT_EQ(filter.phase, Phase::kWaiting);
  EXPECT_EQ(filter.counters.fix_pending, 3u);
  EXPECT_EQ(filter.counters.fix_invalid, 1u);
  const sensor::Fix third = fix_at(4.0, {5000, 10, 0}, 2.0);
  apply(config, filter, third);
  EXPECT_EQ(filter.phase, Phase::kCoarse);
  EXPECT_EQ(filter.counters.fix_used, 1u);
  ASSERT_TRUE(filter.frame);
  EXPECT_EQ(filter.frame->origin(), third.position);
  EXPECT_LT(filter.p.norm(), 1e-6);
  EXPECT_LT((filter.P.block<3, 3>(kPos, kPos) - 4.0 * Matrix3d::Identity()).norm(), 1e-9);
}

TEST(Filter, AConfiguredOriginIsThatOfTheFrameAndBoundsTheSite) {
  EkfConfig config;
  config.site_origin = site().origin();
  config.gps.max_site_radius = 1000.0;
  Filter filter;
  for (const double t : {1.0, 2.0, 3.0, 4.0}) apply(config, filter, fix_at(t, {2000, 0, 0}));
  EXPECT_EQ(filter.counters.fix_implausible, 4u);
  EXPECT_EQ(filter.phase, Phase::kWaiting);
  for (const double t : {5.0, 6.0, 7.0}) apply(config, filter, fix_at(t, {30, -20, 5}));
  EXPECT_EQ(filter.phase, Phase::kCoarse);
  EXPECT_LT((filter.p - Vector3d(30, -20, 5)).norm(), 1e-6);
}

TEST(Filter, TheAntennasArmIsTakenOutAndOpenWithTheHeading) {
  EkfConfig config;
  config.mounting.p_base_antenna = {1.5, 0.0, 2.0};
  const Filter filter = coarse_filter(config);
  EXPECT_NEAR(filter.p.z(), -2.0, 1e-6);
  EXPECT_NEAR(filter.P(kPos, kPos), 1.0 + 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(filter.P(kPos + 1, kPos + 1), 1.0 + 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(filter.P(kPos + 2, kPos + 2), 1.0, 1e-9);
}

TEST(Filter, GravityLevelsItUnlessTheForceIsOfAnotherSize) {
  const EkfConfig config;
  const Matrix3d R = rotation_from_rpy(0.2, -0.1, 0.0);
  Filter filter;
  sensor::Imu falling = imu_at(1.0, R);
  falling.specific_force *= 0.4;
  apply(config, filter, falling);
  EXPECT_FALSE(filter.attitude_set);
  apply(config, filter, imu_at(1.01, R));
  EXPECT_TRUE(filter.attitude_set);
  EXPECT_FALSE(filter.heading_set);
  EXPECT_LT((filter.R - R).norm(), 1e-6);
}

TEST(Filter, AReportedHeadingIsTakenWithItsVarianceWithinBounds) {
  const EkfConfig config;
  const Matrix3d R = rotation_from_rpy(0.1, 0.05, 1.0);
  const auto variance_after = [&](double reported) {
    Filter filter;
    apply(config, filter, oriented(1.0, R, reported));
    EXPECT_NEAR(yaw_of(filter.R), filter.heading_set ? 1.0 : 0.0, 1e-6);
    return filter.heading_set ? filter.P(kAtt + 2, kAtt + 2) : -1.0;
  };
  EXPECT_NEAR(variance_after(0.09), 0.09, 1e-12);
  EXPECT_NEAR(variance_after(1e-6), 0.05 * 0.05, 1e-12) << "no compass is so good";
  EXPECT_NEAR(variance_after(0.0), 0.2 * 0.2, 1e-12) << "it does not say";
  EXPECT_EQ(variance_after(2.0), -1.0) << "that is no heading";
}

TEST(Filter, AnOrientationThatContradictsGravityIsCountedAndNotTaken) {
  EkfConfig config;
  sensor::Imu imu = oriented(1.0, Matrix3d::Identity(), 0.01);
  imu.q_enu_imu = Eigen::Quaterniond(rotation_from_rpy(0.3, 0.0, 1.0));
  Filter filter;
  apply(config, filter, imu);
  EXPECT_EQ(filter.counters.orientations_inconsistent, 1u);
  EXPECT_FALSE(filter.heading_set);
  config.imu.use_orientation = false;
  apply(config, filter, oriented(1.1, Matrix3d::Identity(), 0.01));
  EXPECT_EQ(filter.counters.orientations_inconsistent, 1u);
  EXPECT_FALSE(filter.heading_set);
}

/// The velocity errs across the heading as the heading does: 2 m/s times 0.2 rad.
TEST(Filter, AHeadingBeginsTrackingWithTheWheelsVelocityAlongIt) {
  const EkfConfig config;
  const Matrix3d north = rotation_from_rpy(0, 0, 0.5 * std::numbers::pi);
  Filter filter = coarse_filter(config), without = filter;
  apply(config, filter, wheel_at(at(3.1), 2.0));
  apply(config, filter, oriented(3.1, north, 0.0));
  EXPECT_EQ(filter.phase, Phase::kTracking);
  EXPECT_LT((filter.v - Vector3d(0, 2, 0)).norm(), 1e-6);
  EXPECT_NEAR(filter.P(kVel, kVel), 0.25 + 0.4 * 0.4, 1e-6);
  EXPECT_NEAR(filter.P(kVel + 1, kVel + 1), 0.25, 1e-6);
  EXPECT_NEAR(filter.P(kVel, kAtt + 2), -2.0 * 0.04, 1e-6);
  apply(config, without, oriented(3.1, north, 0.0));
  EXPECT_EQ(without.phase, Phase::kTracking);
  EXPECT_EQ(without.v, Vector3d::Zero());
  EXPECT_NEAR(without.P(kVel, kVel), 9.0, 1e-9);
}

TEST(Filter, BetweenSamplesOfTheImuTheRateIsLinear) {
  const EkfConfig config;
  Filter filter = tracking_filter();
  apply(config, filter, imu_at(0.0));
  apply(config, filter, imu_at(0.1, Matrix3d::Identity(), 0.4));
  EXPECT_NEAR(yaw_of(filter.R), 0.1 * 0.2, 1e-9);
  EXPECT_EQ(filter.counters.imu_gaps, 0u);
  apply(config, filter, imu_at(1.1, Matrix3d::Identity(), 0.4));
  EXPECT_EQ(filter.counters.imu_gaps, 1u);
  EXPECT_NEAR(yaw_of(filter.R), 0.1 * 0.2, 1e-9) << "a gap is not integrated";
  EXPECT_EQ(filter.counters.imu_used, 3u);
}

TEST(Filter, TheLastRateIsHeldAsLongAsItIsFresh) {
  const EkfConfig config;
  Filter with_imu = tracking_filter();
  apply(config, with_imu, imu_at(0.0, Matrix3d::Identity(), 0.2));
  predict_to(config, with_imu, at(0.3));
  EXPECT_NEAR(yaw_of(with_imu.R), 0.3 * 0.2, 1e-9);
  EXPECT_EQ(with_imu.stamp, at(0.3));
  for (const double seconds : {4.0, 9.0}) {
    Filter with_wheels = tracking_filter();
    with_wheels.last_wheel = wheel_at(at(0.0), 0.0, 0.5);
    predict_to(config, with_wheels, at(seconds));
    EXPECT_NEAR(yaw_of(with_wheels.R), 0.5, 1e-9) << "for two steps of half a second";
    EXPECT_EQ(with_wheels.stamp, at(seconds));
  }
}

TEST(Filter, WithoutSensorsItGoesStraightUntilItsHeadingIsLost) {
  const EkfConfig config;
  Filter once = tracking_filter();
  once.v = {3, 0, 0};
  Filter stepwise = once;
  predict_to(config, once, at(10.0));
  for (const double t : {0.2, 3.0, 10.0}) predict_to(config, stepwise, at(t));
  EXPECT_LT((once.p - Vector3d(30, 0, 0)).norm(), 1e-9);
  EXPECT_LT((stepwise.p - once.p).norm(), 1e-9);
  EXPECT_EQ(once.phase, Phase::kTracking);
  predict_to(config, once, at(12.0));  // at 0.3 rad a root second
  EXPECT_EQ(once.phase, Phase::kCoarse);
  EXPECT_EQ(once.counters.heading_lost, 1u);
}

TEST(Filter, FixesThatItRejectsButAgreeAreBelievedAtLast) {
  EkfConfig config;
  config.gps.recovery_time = 5.0;
  Filter filter = coarse_filter(config);
  apply(config, filter, oriented(3.1, Matrix3d::Identity(), 0.0));
  for (const double t : {4.0, 5.0, 6.0, 7.0, 8.0}) apply(config, filter, fix_at(t, {2000, 0, 0}));
  EXPECT_EQ(filter.counters.fix_implausible, 5u);
  EXPECT_EQ(filter.counters.fix_recoveries, 0u);
  EXPECT_LT(filter.p.norm(), 1.0);
  apply(config, filter, fix_at(9.0, {2000, 0, 0}));
  EXPECT_EQ(filter.counters.fix_recoveries, 1u);
  EXPECT_LT((filter.p - filter.frame->to_enu(site().to_geo({2000, 0, 0}))).norm(), 1e-6);
  EXPECT_NEAR(filter.P(kPos, kPos), 1.0, 1e-9);
  EXPECT_EQ(filter.phase, Phase::kTracking);
  apply(config, filter, fix_at(10.0, {2000, 0, 0}));
  EXPECT_EQ(filter.counters.fix_implausible, 6u) << "from there on fixes are used";
}

}  // namespace
}  // namespace fleetmap::localization
