#include "fleetmap/sensor/mavlink_messages.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <limits>

#include "fleetmap/geometry/degree.hpp"
#include "mavlink_golden.hpp"

namespace fleetmap::sensor {
namespace {

using namespace std::chrono_literals;

/// The messages of a type that node-mavlink wrote as v1, v2 and signed v2, with the values of
/// make_golden.mjs.
template <class T>
std::vector<T> golden(bool (*wanted)(const T&) = [](const T&) { return true; }) {
  std::vector<T> found;
  for (const MavlinkFrame& frame : MavlinkFrames().add(fleetmap::testing::golden_mavlink())) {
    const auto message = decode_mavlink(frame);
    if (message && std::holds_alternative<T>(*message) && wanted(std::get<T>(*message)))
      found.push_back(std::get<T>(*message));
  }
  EXPECT_EQ(found.size(), 3u);
  return found;
}

void expect_near(const Eigen::Vector3d& value, const Eigen::Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-9) << value.transpose();
}

TEST(MavlinkMessages, SystemTime) {
  for (const auto& message : golden<MavlinkSystemTime>()) {
    EXPECT_EQ(message.boot, 123456ms);
    EXPECT_EQ(message.unix_time, 1795630359500000us);
  }
}

TEST(MavlinkMessages, GpsRawInt) {
  for (const auto& message : golden<MavlinkGps>()) {
    EXPECT_EQ(message.time.since, 123400ms);
    EXPECT_FALSE(message.time.is_unix);
    EXPECT_EQ(message.fix_type, 6);
    EXPECT_NEAR(message.position.latitude / kDegree, 38.9876543, 1e-12);
    EXPECT_NEAR(message.position.longitude / kDegree, -3.9876543, 1e-12);
    EXPECT_NEAR(message.position.altitude, 703.456, 1e-9) << "above the ellipsoid";
    EXPECT_TRUE(message.has_ellipsoid);
    EXPECT_NEAR(message.sigma_h, 0.014, 1e-12);
    EXPECT_NEAR(message.sigma_v, 0.021, 1e-12);
  }
}

TEST(MavlinkMessages, AFixWithoutExtensionsHasItsAltitudeAboveTheSea) {
  Bytes payload(30);
  payload[16] = 0x10, payload[17] = 0x27;  // alt: 10,000 mm
  const auto message = decode_mavlink({.id = kMavlinkGpsRawInt, .payload = payload});
  ASSERT_TRUE(message);
  EXPECT_NEAR(std::get<MavlinkGps>(*message).position.altitude, 10.0, 1e-9);
  EXPECT_FALSE(std::get<MavlinkGps>(*message).has_ellipsoid);
  EXPECT_EQ(std::get<MavlinkGps>(*message).sigma_h, 0.0);
}

TEST(MavlinkMessages, AttitudeQuaternion) {
  for (const auto& message : golden<MavlinkAttitude>()) {
    EXPECT_EQ(message.boot, 123450ms);
    expect_near(message.q_ned_frd * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());  // forward is east
  }
}

TEST(MavlinkMessages, ScaledImu) {
  for (const auto& message : golden<MavlinkImu>([](const MavlinkImu& imu) { return !imu.high_resolution; })) {
    EXPECT_EQ(message.time.since, 123460ms);
    expect_near(message.specific_force, 9.80665e-3 * Eigen::Vector3d(20.0, -30.0, -1001.0));
    expect_near(message.angular_velocity, {0.011, -0.012, 0.013});
  }
}

TEST(MavlinkMessages, HighresImu) {
  for (const auto& message : golden<MavlinkImu>([](const MavlinkImu& imu) { return imu.high_resolution; })) {
    EXPECT_EQ(message.time.since, 123470ms);
    expect_near(message.specific_force, {0.25, -0.5, -9.75});
    expect_near(message.angular_velocity, {0.125, -0.25, 0.5});
  }
}

TEST(MavlinkMessages, Timesync) {
  for (const auto& message : golden<MavlinkTimesync>()) {
    EXPECT_EQ(message.device, 123480ms);
    EXPECT_EQ(message.asked, 1795630359523ms);
  }
}

TEST(MavlinkMessages, ARequestIsReadAsItWasWritten) {
  const auto frames = MavlinkFrames().add(encode_mavlink({Duration::zero(), 1795630359523456789ns}, 9));
  ASSERT_EQ(frames.size(), 1u);
  const auto message = decode_mavlink(frames[0]);
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<MavlinkTimesync>(*message).asked, 1795630359523456789ns);
}

TEST(MavlinkMessages, NumbersThatMeanNothingAreRefused) {
  const auto refuses = [](std::uint32_t id, Bytes payload) {
    return !decode_mavlink({.id = id, .payload = std::move(payload)});
  };
  EXPECT_TRUE(refuses(kMavlinkAttitudeQuaternion, Bytes(32))) << "a quaternion of zeros";
  EXPECT_TRUE(refuses(kMavlinkAttitudeQuaternion, Bytes(32, 0xff))) << "NaN";
  EXPECT_TRUE(refuses(kMavlinkHighresImu, Bytes(62))) << "nothing is updated";
  Bytes second(63);
  second[60] = 0x3f, second[62] = 1;
  EXPECT_TRUE(refuses(kMavlinkHighresImu, second)) << "a second IMU";
  Bytes late(30, 0xff);
  EXPECT_TRUE(refuses(kMavlinkGpsRawInt, late)) << "a time that no clock shows";
  EXPECT_TRUE(refuses(kMavlinkTimesync, Bytes(16, 0xff))) << "a negative time";
  EXPECT_TRUE(refuses(kMavlinkHeartbeat, Bytes(9)));
}

}  // namespace
}  // namespace fleetmap::sensor
