#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/device_config.hpp"
#include "fleetmap/agent/ouster_config.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/localization/ekf_config.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/ros_codec/points_type.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"

namespace fleetmap::agent {

/// PerceptionConfig::frame_patience of a robot whose drivers run: what is latched comes when they are
/// discovered.
inline constexpr Duration kFramePatience = std::chrono::seconds(2);

/// Names of the sensor topics on the onboard link, as on the wire ("rt/points" is ROS 2's "/points").
struct SensorTopics {
  std::string points, imu, fix, wheel;
  ros_codec::PointsType points_type = ros_codec::PointsType::kPointCloud2;
  SensorTopics();  ///< our own names
};

/// Odometry, EKF and the sensors' topics of one robot.
struct PerceptionConfig {
  odometry::LoamConfig odometry;
  OusterConfig ouster;
  localization::EkfConfig localization;
  /// So long the first samples of a sensor without a stated mount wait for /tf_static.
  Duration frame_patience = Duration::zero();
  std::size_t waiting_scans = 50;  ///< scans that may wait for LOAM; the oldest gives way and is counted
  /// Why the gyro is taken for one that reports deg/s; found in a recording before it is used.
  std::optional<std::string> gyro_in_degrees;
  /// Findings of a recording before it is used, which were logged.
  std::vector<std::string> findings_before;
  odometry::LidarModel lidar = odometry::vlp16();
  SensorTopics topics;
  DeviceConfig devices;
  /// UDP port at which the program receives a Velodyne LiDAR's packets, to publish its scans on topics.points
  /// itself; 0: a driver publishes them. Perception hears the topic either way.
  std::uint16_t velodyne_port = 0;
  bool odometry_uses_imu = true;    ///< angular velocity as rotation prior of LOAM
  bool odometry_uses_wheel = true;  ///< speed as prior of LOAM
  bool uses_gps = true;             ///< else fixes are not heard
  /// The configuration states the mount of LiDAR, IMU and GPS (in the order of sensor::Source), so that
  /// /tf_static does not replace it.
  std::array<bool, sensor::kSources> mount_configured{};
};

}  // namespace fleetmap::agent
