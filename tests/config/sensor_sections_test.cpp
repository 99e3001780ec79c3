#include "sensor_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "section_problems.hpp"
#include "support/ouster_packets.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct PerceptionReading {
  agent::PerceptionConfig perception;
  std::string problems;
};

PerceptionReading perception_of(const std::string& yaml) {
  PerceptionReading result;
  result.problems = problems_of(yaml, [&](Section& top) { read_perception(top, result.perception); });
  return result;
}

TEST(SensorSections, TopicsAreThoseOfRos2OnTheWire) {
  const PerceptionReading r = perception_of("topics: {points: /velodyne_points, imu: rt/imu/data}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.perception.topics.points, "rt/velodyne_points");
  EXPECT_EQ(r.perception.topics.imu, "rt/imu/data");
  EXPECT_EQ(r.perception.topics.fix, agent::SensorTopics().fix);
  EXPECT_THAT(perception_of("topics:\n  wheel: ''\n").problems,
              HasSubstr("robot.yaml:2: topics.wheel: expected the name"));
}

TEST(SensorSections, PointsMayBeOfALivoxDriver) {
  EXPECT_EQ(perception_of("{}").perception.topics.points_type, ros_codec::PointsType::kPointCloud2);
  const PerceptionReading r =
      perception_of("topics: {points: /livox/lidar, points_type: livox_ros_driver2/msg/CustomMsg}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.perception.topics.points_type, ros_codec::PointsType::kLivoxDriver2);
  EXPECT_THAT(perception_of("topics:\n  points_type: CustomMsg\n").problems,
              HasSubstr("robot.yaml:2: topics.points_type: CustomMsg is no type of points that is read; "
                        "expected one of sensor_msgs/msg/PointCloud2"));
}

TEST(SensorSections, AMountThatNoRobotHasIsRefused) {
  const auto problems = [](const std::string& yaml) { return perception_of(yaml).problems; };
  EXPECT_EQ(problems("lidar: {translation: [-12, 0, 15.9], rotation_rpy_deg: [-180, 0, 360]}\n"), "");
  EXPECT_THAT(problems("lidar:\n  translation: [0, 0, 350]\n"),
              HasSubstr("robot.yaml:2: lidar.translation: expected at most 20 m from base_link, and metres"));
  EXPECT_THAT(problems("gps:\n  translation: [0, -21, 0]\n"), HasSubstr("robot.yaml:2: gps.translation: "));
  EXPECT_THAT(problems("imu:\n  rotation_rpy_deg: [1000, 0, 0]\n"),
              HasSubstr("robot.yaml:2: imu.rotation_rpy_deg: expected roll, pitch and yaw of -360 to 360"));
  EXPECT_THAT(problems("imu:\n  translation: [.nan, 0, 0]\n"), HasSubstr("robot.yaml:2: imu.translation: "));
}

TEST(SensorSections, TheLidarIsAModelWithItsMountAndRanges) {
  const PerceptionReading r = perception_of(
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

/// Metadata of a LiDAR in a folder, and `lidar` with what names them.
class OusterSections : public ::testing::Test {
 protected:
  PerceptionReading read_lidar(const std::string& keys, const std::string& more = "") const {
    return perception_of("lidar:\n  ouster_metadata: " + (folder_.path() / "os.json").string() + "\n" + keys +
                         more);
  }
  void SetUp() override {
    folder_.write("os.json", fleetmap::testing::OusterDevice(Duration::zero()).metadata());
  }
  fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(OusterSections, NameTheMetadataAndThePorts) {
  const PerceptionReading r = read_lidar("  ouster_port: 7502\n  ouster_imu_port: 7503\n");
  EXPECT_EQ(r.problems, "");
  ASSERT_TRUE(r.perception.ouster.metadata);
  EXPECT_EQ(r.perception.ouster.metadata->device, "OS-1-16 122");
  EXPECT_EQ(r.perception.ouster.lidar_port, 7502);
  EXPECT_EQ(r.perception.ouster.imu_port, 7503);
  EXPECT_EQ(read_lidar("").problems, "") << "for captures";
  EXPECT_EQ(perception_of("{}").perception.ouster.lidar_port, 0);
}

TEST_F(OusterSections, ProblemsSayWhatToDo) {
  EXPECT_THAT(
      perception_of("lidar:\n  ouster_port: 7502\n").problems,
      HasSubstr("robot.yaml:2: lidar.ouster_port: expected lidar.ouster_metadata as well: a file that "
                "`curl http://SENSOR/api/v1/sensor/metadata` writes"));
  EXPECT_THAT(read_lidar("  ouster_port: 70000\n").problems, HasSubstr("expected a UDP port, usually 7502"));
  EXPECT_THAT(read_lidar("  ouster_imu_port: 7503\n").problems,
              HasSubstr("expected lidar.ouster_port as well"));
  EXPECT_THAT(read_lidar("  ouster_port: 7502\n  ouster_imu_port: 7502\n").problems,
              HasSubstr("lidar.ouster_imu_port: expected another port"));
  EXPECT_THAT(read_lidar("  ouster_port: 7502\n  velodyne_port: 2368\n").problems,
              HasSubstr("lidar.velodyne_port is given as well"));
  EXPECT_THAT(
      read_lidar("  ouster_port: 7502\n  ouster_imu_port: 7503\n", "mavlink: {udp_port: 14550}\n").problems,
      HasSubstr("mavlink.imu: the LiDAR's IMU is used as well"));
  EXPECT_EQ(
      read_lidar("  ouster_port: 7502\n  ouster_imu_port: 7503\n", "mavlink: {udp_port: 14550, imu: false}\n")
          .problems,
      "");
  folder_.write("os.json", "{}");
  EXPECT_THAT(read_lidar("").problems,
              HasSubstr("os.json: beam_altitude_angles, beam_azimuth_angles: expected"));
  EXPECT_THAT(
      perception_of("lidar:\n  ouster_metadata: /no/such.json\n").problems,
      HasSubstr("robot.yaml:2: lidar.ouster_metadata: /no/such.json: cannot be read; expected what `curl"));
}

TEST(SensorSections, TheMapReachesAsFarAsTheScans) {
  EXPECT_EQ(perception_of("lidar: {max_range: 120}\n").perception.odometry.map_radius, 120.0);
  EXPECT_EQ(
      perception_of("lidar: {max_range: 120}\nodometry: {map_radius: 150}\n").perception.odometry.map_radius,
      150.0);
  EXPECT_EQ(perception_of("{}").perception.odometry.map_radius, odometry::LoamConfig{}.map_radius);
}

TEST(SensorSections, TheOdometryAndItsPriorsCanBeSet) {
  const PerceptionReading r = perception_of(
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
  const PerceptionReading r = perception_of(
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
  EXPECT_THAT(perception_of("lidar:\n  model: vlp17\n").problems, HasSubstr("robot.yaml:2: lidar.model: "));
  EXPECT_THAT(perception_of("lidar:\n  range_noise: 5\n").problems,
              HasSubstr("robot.yaml:2: lidar.range_noise: must be"))
      << "a setting of the odometry that stands in another section";
  EXPECT_THAT(perception_of("odometry:\n  max_iterations: 0\n").problems,
              HasSubstr("robot.yaml:2: odometry.max_iterations: must be"));
  for (const char* port : {"0", "65536"}) {
    EXPECT_THAT(perception_of(std::string("lidar:\n  velodyne_port: ") + port).problems,
                HasSubstr("robot.yaml:2: lidar.velodyne_port: expected a UDP port"));
  }
  EXPECT_TRUE(perception_of("{}\n").perception.uses_gps);
  EXPECT_FALSE(perception_of("gps: {use: false}\n").perception.uses_gps);
  EXPECT_THAT(perception_of("gps: {use: false, gpsd: localhost}\n").problems,
              HasSubstr("gps.use: a receiver"));
  EXPECT_THAT(perception_of("gps: {use: false}\nmavlink: {udp_port: 14550}\n").problems,
              HasSubstr("gps.use: the autopilot's GPS"));
  EXPECT_EQ(perception_of("gps: {use: false}\nmavlink: {udp_port: 14550, gps: false}\n").problems, "");
  EXPECT_THAT(perception_of("gps: {geoid: egm2008-5}\n").problems, HasSubstr("gps.geoid: is of use with"));
  EXPECT_EQ(perception_of("gps: {gpsd: localhost, geoid: egm96-5}\n").perception.devices.geoid, "egm96-5");
  EXPECT_THAT(perception_of("gps: {sigma: 1}\n").problems, HasSubstr("gps.sigma: unknown key"));
  EXPECT_THAT(perception_of("wheel: {speed_sigma: 0}\n").problems, HasSubstr("wheel.speed_sigma"));
}

}  // namespace
}  // namespace fleetmap::config
