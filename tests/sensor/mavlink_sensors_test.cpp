#include "fleetmap/sensor/mavlink_sensors.hpp"

#include <gmock/gmock.h>

#include "mavlink_golden.hpp"
#include "sensor/stamps.hpp"
#include "support/mavlink_packets.hpp"

namespace fleetmap::sensor {
namespace {

using namespace fleetmap::testing;
using namespace std::chrono_literals;
using Eigen::Vector3d;

void expect_close(const Vector3d& value, const Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-5) << value.transpose();
}

TEST(MavlinkSensors, TheGoldenStreamGivesTheSamplesOfItsMessages) {
  MavlinkSensors sensors;
  const DeviceSamples samples = sensors.add(golden_mavlink(), kSwitchedOn + 200s);
  ASSERT_EQ(samples.fixes.size(), 3u);
  EXPECT_TRUE(samples.fixes[0].valid);
  EXPECT_NEAR(samples.fixes[0].covariance(0, 0), 0.014 * 0.014, 1e-12);
  EXPECT_NEAR(samples.fixes[0].covariance(2, 2), 0.021 * 0.021, 1e-12);
  ASSERT_EQ(samples.imu.size(), 4u) << "one of SCALED_IMU, before the first of HIGHRES_IMU";
  expect_close(samples.imu[1].specific_force, {0.25, 0.5, 9.75});
  expect_close(samples.imu[1].angular_velocity, {0.125, 0.25, -0.5});
  // All came at once; the newest was on time.
  EXPECT_NEAR(to_seconds(samples.fixes[2].stamp - (kSwitchedOn + 200s)), 123.400 - 123.470, 1e-6);
}

TEST(MavlinkSensors, AxesAreForwardLeftUpAndEastNorthUp) {
  // q_ned_frd by heading; forward in ENU.
  for (const auto& [heading, forward] :
       {std::pair(0.0, Vector3d(0, 1, 0)), std::pair(M_PI_2, Vector3d(1, 0, 0)),
        std::pair(M_PI, Vector3d(0, -1, 0))}) {
    MavlinkSensors sensors;
    sensors.add(attitude_quaternion(1000, Eigen::Quaterniond(Eigen::AngleAxisd(heading, Vector3d::UnitZ()))),
                kSwitchedOn + 1s);
    const auto samples =
        sensors.add(highres_imu(1'000'000, {0, 0, -9.81}, Vector3d::Zero()), kSwitchedOn + 1s);
    ASSERT_EQ(samples.imu.size(), 1u);
    ASSERT_TRUE(samples.imu[0].q_enu_imu);
    expect_close(*samples.imu[0].q_enu_imu * Vector3d::UnitX(), forward);
    expect_close(*samples.imu[0].q_enu_imu * samples.imu[0].specific_force, {0, 0, 9.81});
  }
}

TEST(MavlinkSensors, AnOrientationIsTurnedOnToTheSampleAndNotUsedWhenOld) {
  MavlinkSensors sensors;
  sensors.add(attitude_quaternion(1000, Eigen::Quaterniond::Identity()), kSwitchedOn + 1s);
  // Clockwise from above with 1 rad/s: north by east.
  auto samples = sensors.add(highres_imu(1'100'000, {0, 0, -9.81}, {0, 0, 1.0}), kSwitchedOn + 1100ms);
  ASSERT_TRUE(samples.imu.at(0).q_enu_imu);
  expect_close(*samples.imu[0].q_enu_imu * Vector3d::UnitX(), {std::sin(0.1), std::cos(0.1), 0.0});
  samples = sensors.add(highres_imu(1'300'000, {0, 0, -9.81}, {0, 0, 1.0}), kSwitchedOn + 1300ms);
  EXPECT_FALSE(samples.imu.at(0).q_enu_imu);
}

TEST(MavlinkSensors, ScaledImuIsUsedWhereThereIsNoHighres) {
  MavlinkSensors sensors;
  EXPECT_EQ(sensors.add(scaled_imu(1000), kSwitchedOn + 1s).imu.size(), 1u);
  EXPECT_EQ(
      sensors.add(highres_imu(1'010'000, {0, 0, -9.81}, Vector3d::Zero()), kSwitchedOn + 1010ms).imu.size(),
      1u);
  EXPECT_EQ(sensors.add(scaled_imu(1020), kSwitchedOn + 1020ms).imu.size(), 0u);
  EXPECT_EQ(sensors.add(scaled_imu(2020), kSwitchedOn + 2020ms).imu.size(), 1u);
}

TEST(MavlinkSensors, TimesSinceTheEpochAreRelatedBySystemTime) {
  constexpr std::uint64_t kUnix = 1'795'000'000'000'000;  // us; not this computer's clock
  MavlinkSensors sensors;
  EXPECT_TRUE(sensors.add(gps_raw_int(kUnix + 9'800'000, 3), kSwitchedOn + 10s).fixes.empty());
  EXPECT_EQ(sensors.counters().unplaced, 1u);
  sensors.add(system_time(kUnix + 10'000'000, 10'000), kSwitchedOn + 10s + 5ms);
  const auto samples = sensors.add(gps_raw_int(kUnix + 9'900'000, 3), kSwitchedOn + 10s + 100ms);
  ASSERT_EQ(samples.fixes.size(), 1u);
  EXPECT_NEAR(to_seconds(samples.fixes[0].stamp - kSwitchedOn), 9.905, 1e-6);
}

TEST(MavlinkSensors, AnAnsweredRequestTakesTheWayOutOfTheStamps) {
  MavlinkSensors sensors;
  sensors.add(scaled_imu(1000), kSwitchedOn + 1s + 12ms);  // 12 ms on the wire
  const auto request = MavlinkFrames().add(sensors.clock_request(kSwitchedOn + 2s));
  ASSERT_EQ(request.size(), 1u);
  const auto asked = std::get<MavlinkTimesync>(*decode_mavlink(request[0])).asked;
  EXPECT_EQ(Stamp(asked), kSwitchedOn + 2s);
  sensors.add(encode_mavlink({2s + 4ms, asked}, 0), kSwitchedOn + 2s + 10ms);
  EXPECT_EQ(sensors.clock().uncertainty(), 5ms);
  const auto samples = sensors.add(scaled_imu(3000), kSwitchedOn + 3s + 12ms);
  EXPECT_NEAR(to_seconds(samples.imu.at(0).stamp - (kSwitchedOn + 3s)), 0.001, 1e-6);
}

TEST(MavlinkSensors, AFixWithoutAltitudeIsNone) {
  MavlinkSensors sensors;
  sensors.add(scaled_imu(1000), kSwitchedOn + 1s);
  for (const auto& [type, valid] : {std::pair(0, false), {1, false}, {2, false}, {3, true}, {6, true}}) {
    const auto samples = sensors.add(gps_raw_int(990'000, type), kSwitchedOn + 1s);
    ASSERT_EQ(samples.fixes.size(), 1u);
    EXPECT_EQ(samples.fixes[0].valid, valid) << type;
  }
}

TEST(MavlinkSensors, AnotherSystemIsHeardOnceTheFirstIsSilent) {
  MavlinkSensors sensors;
  sensors.add(scaled_imu(1000), kSwitchedOn + 1s);
  EXPECT_TRUE(sensors.add(golden_mavlink(), kSwitchedOn + 2s).imu.empty());
  EXPECT_EQ(sensors.counters().of_other_systems, 18u);
  EXPECT_FALSE(sensors.add(golden_mavlink(), kSwitchedOn + 9s).imu.empty());
}

TEST(MavlinkSensors, AnAutopilotThatStartsAnewIsAnotherClock) {
  MavlinkSensors sensors;
  for (std::uint32_t k = 0; k < 50; ++k)
    sensors.add(scaled_imu(60'000 + 20 * k), kSwitchedOn + 60s + k * 20ms);
  DeviceSamples samples;
  for (std::uint32_t k = 0; k < 50; ++k)
    samples = sensors.add(scaled_imu(3'000 + 20 * k), kSwitchedOn + 70s + k * 20ms);
  EXPECT_EQ(sensors.counters().restarts, 1u);
  EXPECT_NEAR(to_seconds(samples.imu.at(0).stamp - (kSwitchedOn + 70s + 49 * 20ms)), 0.0, 1e-6);
}

}  // namespace
}  // namespace fleetmap::sensor
