#include "sensor_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct Read {
  agent::PerceptionConfig perception;
  std::string problems;
};

Read read(const std::string& yaml) {
  Read result;
  result.problems = problems_of(yaml, [&](Section& top) { read_perception(top, result.perception); });
  return result;
}

TEST(SensorSections, TopicsAreThoseOfRos2OnTheWire) {
  const Read r = read("topics: {points: /velodyne_points, imu: rt/imu/data}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.perception.topics.points, "rt/velodyne_points");
  EXPECT_EQ(r.perception.topics.imu, "rt/imu/data");
  EXPECT_EQ(r.perception.topics.fix, agent::SensorTopics().fix);
  EXPECT_THAT(read("topics:\n  wheel: ''\n").problems,
              HasSubstr("robot.yaml:2: topics.wheel: expected the name"));
}

TEST(SensorSections, TheLidarIsAModelWithItsMountAndRanges) {
  const Read r = read(
      "lidar: {model: os1-64, translation: [0.1, 0, 0.35], rotation_rpy_deg: [0, 0, 90], max_range: 55,\n"
      "  min_range: 1.5, range_noise: 0.05, velodyne_port: 2368}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.perception.lidar.name, "os1-64");
  const Pose& T_base_lidar = r.perception.odometry.T_base_lidar;
  EXPECT_TRUE(T_base_lidar.translation().isApprox(Eigen::Vector3d(0.1, 0, 0.35)));
  EXPECT_TRUE((T_base_lidar.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_EQ(r.perception.odometry.max_range, 55.0);
  EXPECT_EQ(r.perception.odometry.min_range, 1.5);
  EXPECT_EQ(r.perception.odometry.range_noise, 0.05);
  EXPECT_EQ(r.perception.velodyne_port, 2368);
}

TEST(SensorSections, TheMapReachesAsFarAsTheScans) {
  EXPECT_EQ(read("lidar: {max_range: 120}\n").perception.odometry.map_radius, 120.0);
  EXPECT_EQ(read("lidar: {max_range: 120}\nodometry: {map_radius: 150}\n").perception.odometry.map_radius,
            150.0);
  EXPECT_EQ(read("{}").perception.odometry.map_radius, odometry::LoamConfig{}.map_radius);
}

TEST(SensorSections, TheOdometryAndItsPriorsCanBeSet) {
  const Read r = read(
      "odometry: {use_imu: false, use_wheel: false, deskew: false, match_spacing: 0.5, insert_spacing: "
      "0.25,\n"
      "  max_map_windows: 20000, fine_resolution: 0.4, coarse_resolution: 2, max_iterations: 5, "
      "initial_speed: 2,\n"
      "  linear_acceleration: 3, angular_acceleration: 4, gyro_noise: 0.02, wheel_speed_noise: 0.3,\n"
      "  waiting_scans: 3}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_FALSE(r.perception.odometry_uses_imu);
  EXPECT_FALSE(r.perception.odometry_uses_wheel);
  const odometry::LoamConfig& loam = r.perception.odometry;
  EXPECT_FALSE(loam.deskew);
  EXPECT_EQ(loam.match_spacing, 0.5);
  EXPECT_EQ(loam.insert_spacing, 0.25);
  EXPECT_EQ(loam.max_map_windows, 20'000);
  EXPECT_EQ(loam.fine_resolution, 0.4);
  EXPECT_EQ(loam.coarse_resolution, 2.0);
  EXPECT_EQ(loam.max_iterations, 5);
  EXPECT_EQ(loam.initial_speed, 2.0);
  EXPECT_EQ(loam.linear_acceleration, 3.0);
  EXPECT_EQ(loam.angular_acceleration, 4.0);
  EXPECT_EQ(loam.gyro_noise, 0.02);
  EXPECT_EQ(loam.wheel_speed_noise, 0.3);
  EXPECT_EQ(r.perception.waiting_scans, 3u);
}

TEST(SensorSections, ImuGpsAndWheelsAreOfTheFilter) {
  const Read r = read(
      "imu: {translation: [0, 0.2, 0], rotation_rpy_deg: [0, 0, 180], gyro_noise: 0.003, accel_noise: 0.04,\n"
      "  use_orientation: true, max_gap: 0.5}\n"
      "gps: {translation: [0, 0, 0.6], correlation_time: 20, correlated_share: 0.5, sigma_floor: 0.2, "
      "max_speed: 9}\n"
      "wheel: {speed_sigma: 0.2, speed_scale: 0.03, yaw_rate_sigma: 0.04, turn_offset: 0.1}\n");
  EXPECT_EQ(r.problems, "");
  const localization::EkfConfig& ekf = r.perception.localization;
  EXPECT_EQ(ekf.mounting.T_base_imu.translation().y(), 0.2);
  const Eigen::Vector3d turned = r.perception.odometry.q_base_imu * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(turned.isApprox(-Eigen::Vector3d::UnitX())) << "the odometry knows the mount, too";
  EXPECT_EQ(ekf.imu.gyro_noise, 0.003);
  EXPECT_EQ(ekf.imu.accel_noise, 0.04);
  EXPECT_TRUE(ekf.imu.use_orientation);
  EXPECT_EQ(ekf.imu.max_gap, 0.5);
  EXPECT_EQ(ekf.mounting.p_base_antenna.z(), 0.6);
  EXPECT_EQ(ekf.gps.correlation_time, 20.0);
  EXPECT_EQ(ekf.gps.correlated_share, 0.5);
  EXPECT_EQ(ekf.gps.sigma_floor, 0.2);
  EXPECT_EQ(ekf.gps.max_speed, 9.0);
  EXPECT_EQ(ekf.wheel.speed_sigma, 0.2);
  EXPECT_EQ(ekf.wheel.speed_scale, 0.03);
  EXPECT_EQ(ekf.wheel.yaw_rate_sigma, 0.04);
  EXPECT_EQ(ekf.wheel.turn_offset, 0.1);
}

TEST(SensorSections, ProblemsNameTheKeyWhereverItStands) {
  EXPECT_THAT(read("lidar:\n  model: vlp17\n").problems, HasSubstr("robot.yaml:2: lidar.model: "));
  EXPECT_THAT(read("lidar:\n  range_noise: 5\n").problems,
              HasSubstr("robot.yaml:2: lidar.range_noise: must be"))
      << "a setting of the odometry that stands in another section";
  EXPECT_THAT(read("odometry:\n  max_iterations: 0\n").problems,
              HasSubstr("robot.yaml:2: odometry.max_iterations: must be"));
  for (const char* port : {"0", "65536"}) {
    EXPECT_THAT(read(std::string("lidar:\n  velodyne_port: ") + port).problems,
                HasSubstr("robot.yaml:2: lidar.velodyne_port: expected a UDP port"));
  }
  EXPECT_THAT(read("gps: {sigma: 1}\n").problems, HasSubstr("gps.sigma: unknown key"));
  EXPECT_THAT(read("wheel: {speed_sigma: 0}\n").problems, HasSubstr("wheel.speed_sigma"));
}

}  // namespace
}  // namespace fleetmap::config
