#include "twin_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

const std::string kSensors = std::string(FLEETMAP_SOURCE_DIR) + "/config/sensors/";

struct RobotTwinReading {
  sim::RobotTwinConfig robot;
  std::vector<SwitchedOff> switched_off;
  std::string problems;
};

RobotTwinReading robot_twin_of(const std::string& yaml) {
  Document document = Document::from(YAML::Load(yaml), "fleet.yaml");
  Section agent(document, document.root(), "");
  RobotTwinReading result;
  read_robot_twin(agent, result.robot, result.switched_off);
  if (const Status status = document.status(); !status) result.problems = status.error().message;
  return result;
}

TEST(TwinSections, WithoutTheKeyTheRobotCarriesAVlp16) {
  const RobotTwinReading r = robot_twin_of("{}");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.robot.lidar.name, "vlp16");
  EXPECT_TRUE(r.robot.validate());
  EXPECT_FALSE(r.robot.has_start);
}

TEST(TwinSections, MountsAreThoseOfTheAgent) {
  const RobotTwinReading r = robot_twin_of(
      "lidar: {model: vlp16, translation: [0.1, 0, 0.35], rotation_rpy_deg: [0, 0, 90]}\n"
      "imu: {translation: [0, 0.2, 0], gyro_noise: 0.1}\n"
      "gps: {translation: [0, 0, 0.6]}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_TRUE(r.robot.T_base_lidar.translation().isApprox(Eigen::Vector3d(0.1, 0, 0.35)));
  EXPECT_TRUE((r.robot.T_base_lidar.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(r.robot.T_base_imu.translation().isApprox(Eigen::Vector3d(0, 0.2, 0)));
  EXPECT_EQ(r.robot.p_base_antenna.z(), 0.6);
  EXPECT_EQ(r.robot.imu.gyro_noise, sim::ImuSpec{}.gyro_noise);  // the estimator's, not the device's
}

TEST(TwinSections, EverythingOfTheRobotCanBeSet) {
  const RobotTwinReading r =
      robot_twin_of("robot:\n  lidar: " + kSensors +
                    "os1-64.yaml\n"
                    "  lidar_rate: 5\n  range_noise: 0.08\n  max_range: 40\n  start: [3, -4, 90]\n  seed: 9\n"
                    "  imu: {rate: 200, heading_sigma_deg: 10, reports_orientation: false}\n"
                    "  gps: {drift_sigma: 3, outages: [{from: 10, until: 20}, {from: 30, until: 31}],\n"
                    "        jumps: {per_hour: 6, size: 12, duration: 5}, altitude: {wave: 4, period: 90}}\n"
                    "  wheels: {slip: 0.2}\n  vehicle: {max_speed: 1.2, battery_wh: 50}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.robot.lidar.name, "os1-64");
  EXPECT_EQ(r.robot.lidar.columns, 1024);
  EXPECT_EQ(r.robot.lidar.rate, 5.0);
  EXPECT_EQ(r.robot.lidar.range_noise, 0.08);
  EXPECT_EQ(r.robot.lidar.max_range, 40.0);
  EXPECT_TRUE(r.robot.has_start);
  EXPECT_EQ(r.robot.start, Eigen::Vector2d(3, -4));
  EXPECT_DOUBLE_EQ(r.robot.start_yaw, std::numbers::pi / 2);
  EXPECT_EQ(r.robot.seed, 9u);
  EXPECT_EQ(r.robot.imu.rate, 200.0);
  EXPECT_FALSE(r.robot.imu.reports_orientation);
  EXPECT_NEAR(r.robot.imu.heading_sigma, 0.1745, 1e-4);
  ASSERT_EQ(r.robot.gps.outages.size(), 2u);
  EXPECT_EQ(r.robot.gps.outages[1].until, 31.0);
  EXPECT_EQ(r.robot.gps.jump_size, 12.0);
  EXPECT_EQ(r.robot.gps.altitude_wave, 4.0);
  EXPECT_EQ(r.robot.gps.altitude_period, 90.0);
  EXPECT_EQ(r.robot.wheels.slip, 0.2);
  EXPECT_EQ(r.robot.vehicle.battery_wh, 50.0);
}

TEST(TwinSections, ARobotWithoutGpsMustBeLed) {
  const RobotTwinReading led = robot_twin_of("robot: {guided: true, gps: {fitted: false}}");
  EXPECT_EQ(led.problems, "");
  EXPECT_TRUE(led.robot.guided);
  EXPECT_FALSE(led.robot.gps.fitted);
  EXPECT_FALSE(robot_twin_of("robot: {}").robot.guided);
  EXPECT_THAT(robot_twin_of("robot:\n  gps: {fitted: false}\n").problems,
              HasSubstr("robot.guided: a robot whose gps is not fitted cannot tell where to drive"));
}

TEST(TwinSections, RobotsErrDifferently) {
  EXPECT_NE(robot_twin_of("id: r1").robot.seed, robot_twin_of("id: r2").robot.seed);
  EXPECT_EQ(robot_twin_of("id: r1").robot.seed, robot_twin_of("id: r1").robot.seed);
}

TEST(TwinSections, ASlowerVlp16HasMoreColumns) {
  EXPECT_EQ(robot_twin_of("robot: {lidar_rate: 5}").robot.lidar.columns, 3600);
}

TEST(TwinSections, ARobotIsSwitchedOffForATimeOrForEver) {
  const RobotTwinReading r = robot_twin_of("robot:\n  switched_off: [{from: 5, until: 20.5}, {from: 30}]\n");
  EXPECT_EQ(r.problems, "");
  ASSERT_EQ(r.switched_off.size(), 2u);
  EXPECT_EQ(r.switched_off[0].from, 5.0);
  EXPECT_EQ(r.switched_off[0].until, 20.5);
  EXPECT_EQ(r.switched_off[1].from, 30.0);
  EXPECT_FALSE(r.switched_off[1].until);
  EXPECT_THAT(robot_twin_of("robot:\n  switched_off: [{from: 5, until: 2}]\n").problems,
              HasSubstr("fleet.yaml:2: robot.switched_off[0].until: expected 0 <= from < until"));
  EXPECT_THAT(robot_twin_of("robot:\n  switched_off: [{from: 5}, {from: 9}]\n").problems,
              HasSubstr("fleet.yaml:2: robot.switched_off[1].from: expected the times in order"));
  EXPECT_THAT(robot_twin_of("robot:\n  switched_off: [{until: 9}]\n").problems,
              HasSubstr("robot.switched_off[0].from: expected s"));
}

TEST(TwinSections, ProblemsNameFileLineAndKey) {
  EXPECT_THAT(robot_twin_of("robot:\n  lidar: none.yaml\n").problems,
              HasSubstr("fleet.yaml:2: robot.lidar: none.yaml: no such file"));
  EXPECT_THAT(robot_twin_of("robot:\n  start: [1, 2]\n").problems,
              HasSubstr("fleet.yaml:2: robot.start: expected"));
  EXPECT_THAT(robot_twin_of("robot:\n  lidar_rate: 0\n").problems,
              HasSubstr("fleet.yaml:2: robot.lidar_rate"));
  EXPECT_THAT(robot_twin_of("robot:\n  max_range: 0.1\n").problems,
              HasSubstr("fleet.yaml:2: robot.max_range: must be greater"));
  EXPECT_THAT(robot_twin_of("robot:\n  gps:\n    outages: [{from: 5, until: 1}]\n").problems,
              HasSubstr("fleet.yaml:3: robot.gps.outages[0].until: expected"));
  EXPECT_THAT(robot_twin_of("robot:\n  vehicle: {radius: -1}\n").problems,
              HasSubstr("fleet.yaml:2: robot.vehicle.radius: must be"));
  EXPECT_THAT(robot_twin_of("robot:\n  wheel: {}\n").problems,
              HasSubstr("robot.wheel: unknown key; did you mean"));
}

}  // namespace
}  // namespace fleetmap::config
