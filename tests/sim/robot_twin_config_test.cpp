#include "fleetmap/sim/robot_twin_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

RobotTwinConfig valid() {
  RobotTwinConfig config;
  config.lidar = vlp16_spec();
  return config;
}

TEST(RobotTwinConfig, NeedsALidarAndHasTheRest) {
  EXPECT_TRUE(valid().validate());
  EXPECT_FALSE(RobotTwinConfig{}.validate());
}

TEST(RobotTwinConfig, StartAndMountsAreFinite) {
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.start.y() = kNaN<double>; }, "start");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.start_yaw = kNaN<double>; }, "start");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.T_base_lidar.translation().x() = kNaN<double>; }, "mounts");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.T_base_imu.linear()(0, 0) = kNaN<double>; }, "mounts");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.p_base_antenna.z() = kNaN<double>; }, "mounts");
}

TEST(RobotTwinConfig, ItsPartsAreCheckedAndNamed) {
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.lidar.max_range = -1.0; }, "lidar.");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.imu.rate = 0.0; }, "imu.rate");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.gps.rate = 0.0; }, "gps.rate");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.wheels.rate = 0.0; }, "wheels.rate");
  expect_refused(
      valid(), [](RobotTwinConfig& c) { c.vehicle.max_speed = 0.0; }, "vehicle.max_speed");
}

}  // namespace
}  // namespace fleetmap::sim
