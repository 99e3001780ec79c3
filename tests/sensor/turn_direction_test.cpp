#include "fleetmap/sensor/turn_direction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::sensor {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Turning {
  float mirror = 1.0f;  ///< of the LiDAR's y axis
  double gyro_sign = 1.0;
  std::optional<double> wheel_sign = 1.0;
  double turn_rate = 0.5;   ///< rad/s
  double gyro_scale = 1.0;  ///< of its unit
};

/// A robot turns on the spot for 4 s in a room whose walls are nearer on some sides.
std::optional<std::string> finding_of(const Turning& turning) {
  TurnDirection direction(Eigen::Matrix3d::Identity(), Eigen::Quaterniond::Identity());
  for (int tick = 0; tick < 400; ++tick) {
    const double t = 0.01 * tick;
    const Stamp stamp = stamp_from_ns(0) + from_seconds(t);
    Imu imu;
    imu.stamp = stamp;
    imu.angular_velocity.z() = turning.gyro_sign * turning.gyro_scale * turning.turn_rate;
    direction.add(imu);
    Wheel wheel;
    wheel.stamp = stamp;
    if (turning.wheel_sign) wheel.yaw_rate = *turning.wheel_sign * turning.turn_rate;
    direction.add(wheel);
    if (tick % 10 != 0) continue;
    Scan scan;
    scan.stamp = stamp;
    for (int k = 0; k < 720; ++k) {
      const double azimuth = 0.5 * k * M_PI / 180.0, in_room = azimuth + turning.turn_rate * t;
      const double range = 10.0 + 3.0 * std::sin(in_room) + 2.0 * std::sin(3.0 * in_room + 1.0) +
                           (std::cos(7.0 * in_room) > 0.6 ? 4.0 : 0.0);
      ScanPoint point;
      point.position =
          Eigen::Vector3d(range * std::cos(azimuth), range * std::sin(azimuth), 0.5).cast<float>();
      point.position.y() *= turning.mirror;
      scan.points.push_back(point);
    }
    direction.add(scan);
  }
  return direction.finding();
}

TEST(TurnDirection, IsSilentOnASoundRobotAndOnOneThatDrivesStraight) {
  EXPECT_EQ(finding_of({}), std::nullopt);
  EXPECT_EQ(finding_of({.turn_rate = -0.5}), std::nullopt);
  EXPECT_EQ(finding_of({.mirror = -1.0f, .turn_rate = 0.05}), std::nullopt);
}

TEST(TurnDirection, IsSilentOnAGyroInDegrees) {
  for (const double turn_rate : {0.05, 0.1, 0.2, 0.5}) {
    EXPECT_EQ(finding_of({.turn_rate = turn_rate, .gyro_scale = 180.0 / M_PI}), std::nullopt) << turn_rate;
  }
}

TEST(TurnDirection, IsDecidedOnceAfterARadian) {
  TurnDirection direction(Eigen::Matrix3d::Identity(), Eigen::Quaterniond::Identity());
  Scan scan;
  double turned = 0.0;
  for (int k = 0; !direction.decided() && k < 1000; ++k) {
    Imu imu;
    imu.stamp = scan.stamp = stamp_from_ns(0) + std::chrono::milliseconds(100 * k);
    imu.angular_velocity.z() = 1.5;
    turned = 0.15 * k;
    direction.add(imu);
    direction.add(scan);
  }
  EXPECT_GE(turned, 1.0);
  EXPECT_LT(turned, 1.4);
}

TEST(TurnDirection, NamesTheSensorThatTheTwoOthersContradict) {
  EXPECT_THAT(finding_of({.mirror = -1.0f}).value_or(""), HasSubstr("its points are mirrored"));
  EXPECT_THAT(finding_of({.gyro_sign = -1.0}).value_or(""), StartsWith("IMU: "));
}

TEST(TurnDirection, NamesBothWhereNoWheelsDecide) {
  const std::string text = finding_of({.mirror = -1.0f, .wheel_sign = std::nullopt}).value_or("");
  EXPECT_THAT(text, HasSubstr("mirrored"));
  EXPECT_THAT(text, HasSubstr("the sign of the gyro's z axis"));
}

}  // namespace
}  // namespace fleetmap::sensor
