#include "fleetmap/ros_codec/samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::ros_codec {
namespace {

using ::testing::HasSubstr;
const double kNan = std::nan("");

TEST(ImuMessage, RoundTrip) {
  sensor::Imu imu;
  imu.stamp = stamp_from_ns(1'317'000'000'123'456'789);
  imu.angular_velocity = {0.1, -0.2, 0.3};
  imu.specific_force = {0.5, 0.6, 9.81};
  imu.q_enu_imu = Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d(0.6, 0.0, 0.8)));
  imu.orientation_variance = {1e-4, 2e-4, 3e-4};
  const auto back = decode<sensor::Imu>(encode(imu));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->stamp, imu.stamp);
  EXPECT_EQ(back->angular_velocity, imu.angular_velocity);
  EXPECT_EQ(back->specific_force, imu.specific_force);
  ASSERT_TRUE(back->q_enu_imu);
  EXPECT_LT(back->q_enu_imu->angularDistance(*imu.q_enu_imu), 1e-12);
  EXPECT_EQ(back->orientation_variance, imu.orientation_variance);
}

TEST(ImuMessage, NoOrientationIsRep145s) {
  EXPECT_FALSE(decode<sensor::Imu>(encode(sensor::Imu{}))->q_enu_imu);
  sensor::Imu zero;
  zero.q_enu_imu = Eigen::Quaterniond(0, 0, 0, 0);
  EXPECT_FALSE(decode<sensor::Imu>(encode(zero))->q_enu_imu);
}

TEST(ImuMessage, NonFiniteRatesAreRefused) {
  sensor::Imu imu;
  imu.angular_velocity.x() = kNan;
  EXPECT_THAT(decode<sensor::Imu>(encode(imu)).error().message, HasSubstr("angular_velocity is not finite"));
  imu = {};
  imu.specific_force.z() = INFINITY;
  EXPECT_THAT(decode<sensor::Imu>(encode(imu)).error().message,
              HasSubstr("linear_acceleration is not finite"));
}

TEST(FixMessage, RoundTrip) {
  sensor::Fix fix;
  fix.stamp = stamp_from_ns(5);
  fix.position = geo_point_from_degrees(49.011, 8.42, 112.8);
  fix.covariance << 2, 0.5, 0, 0.5, 3, 0, 0, 0, 9;
  const auto back = decode<sensor::Fix>(encode(fix));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_NEAR(back->position.latitude, fix.position.latitude, 1e-15);
  EXPECT_NEAR(back->position.longitude, fix.position.longitude, 1e-15);
  EXPECT_EQ(back->position.altitude, fix.position.altitude);
  EXPECT_EQ(back->covariance, fix.covariance);
  EXPECT_TRUE(back->valid);
}

TEST(FixMessage, NoFixAndNonsenseAreInvalid) {
  sensor::Fix fix;
  fix.valid = false;
  EXPECT_FALSE(decode<sensor::Fix>(encode(fix))->valid);
  fix.valid = true;
  fix.position.latitude = kNan;
  EXPECT_FALSE(decode<sensor::Fix>(encode(fix))->valid);
  fix.position = geo_point_from_degrees(95.0, 8.0, 0.0);
  EXPECT_FALSE(decode<sensor::Fix>(encode(fix))->valid);
}

TEST(FixMessage, AnAbsurdCovarianceIsPassedOn) {
  sensor::Fix fix;
  fix.covariance(1, 1) = kNan;
  const auto back = decode<sensor::Fix>(encode(fix));
  ASSERT_TRUE(back);
  EXPECT_TRUE(std::isnan(back->covariance(1, 1)));
}

TEST(WheelMessage, RoundTripWithAndWithoutYawRate) {
  EXPECT_EQ(decode<sensor::Wheel>(encode(sensor::Wheel{stamp_from_ns(9), 1.5, 0.25}))->yaw_rate, 0.25);
  const auto without = decode<sensor::Wheel>(encode(sensor::Wheel{stamp_from_ns(9), -1.5, {}}));
  ASSERT_TRUE(without);
  EXPECT_EQ(without->stamp, stamp_from_ns(9));
  EXPECT_EQ(without->forward_speed, -1.5);
  EXPECT_FALSE(without->yaw_rate);
  EXPECT_THAT(decode<sensor::Wheel>(encode(sensor::Wheel{{}, kNan, {}})).error().message,
              HasSubstr("twist.linear.x is not finite"));
}

TEST(OdometryMessage, RoundTripAndRefusals) {
  OdometryMsg odometry{stamp_from_ns(77), se3_exp((Vector6d() << 1, 2, 3, 0.1, 0.2, 3.0).finished()),
                       0.5 * Matrix6d::Identity(), (Vector6d() << 1, 2, 3, 4, 5, 6).finished(),
                       0.125 * Matrix6d::Identity()};
  odometry.covariance(0, 5) = odometry.covariance(5, 0) = 0.25;
  const auto back = decode<OdometryMsg>(encode(odometry));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->T_odom_base.isApprox(odometry.T_odom_base, 1e-12));
  EXPECT_EQ(back->covariance, odometry.covariance);
  EXPECT_EQ(back->twist, odometry.twist);
  EXPECT_EQ(back->twist_covariance, odometry.twist_covariance);
  odometry.twist[3] = kNan;
  EXPECT_THAT(decode<OdometryMsg>(encode(odometry)).error().message, HasSubstr("twist is not finite"));
  odometry.T_odom_base.translation().y() = kNan;
  EXPECT_THAT(decode<OdometryMsg>(encode(odometry)).error().message,
              HasSubstr("pose.position is not finite"));
}

TEST(VelocityCommandMessage, RoundTripAndRefusal) {
  const auto back = decode<VelocityCommand>(encode(VelocityCommand{0.7, -0.3}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->forward_speed, 0.7);
  EXPECT_EQ(back->yaw_rate, -0.3);
  EXPECT_THAT(decode<VelocityCommand>(encode(VelocityCommand{kNan, 0})).error().message,
              HasSubstr("not finite"));
}

TEST(RosTime, NanosecondsBeyondASecondAreRefused) {
  Bytes bytes = encode(sensor::Imu{});
  bytes[4 + 7] = 0x7f;
  EXPECT_THAT(decode<sensor::Imu>(bytes).error().message, HasSubstr("is not a time"));
}

TEST(BatteryMessage, RoundTripAndLimits) {
  const sensor::Battery battery{Stamp(std::chrono::seconds(100)), 0.25};
  const auto back = decode<sensor::Battery>(encode(battery));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->stamp, battery.stamp);
  EXPECT_EQ(back->share, 0.25);
  EXPECT_THAT(decode<sensor::Battery>(encode(sensor::Battery{{}, 1.5})).error().message,
              HasSubstr("percentage"));
}

TEST(FixMessage, HeightsAboveSeaLevelAreMarkedAndOtherBytesStay) {
  sensor::Fix fix{.stamp = stamp_from_ns(5), .position = geo_point_from_degrees(49.0, 8.0, 112.0)};
  EXPECT_FALSE(decode<sensor::Fix>(encode(fix))->above_sea_level);
  const Bytes ellipsoidal = encode(fix);
  fix.above_sea_level = true;
  const Bytes marked = encode(fix);
  EXPECT_TRUE(decode<sensor::Fix>(marked)->above_sea_level);
  ASSERT_EQ(marked.size(), ellipsoidal.size());
  std::size_t differing = 0;
  for (std::size_t k = 0; k < marked.size(); ++k) differing += marked[k] != ellipsoidal[k] ? 1 : 0;
  EXPECT_EQ(differing, 1u);
}

}  // namespace
}  // namespace fleetmap::ros_codec
