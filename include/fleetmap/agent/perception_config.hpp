#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "fleetmap/agent/device_config.hpp"
#include "fleetmap/localization/ekf_config.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/odometry/loam_config.hpp"

namespace fleetmap::agent {

/// Names of the sensor topics on the onboard link, as on the wire ("rt/points" is ROS 2's "/points").
struct SensorTopics {
  std::string points, imu, fix, wheel;
  SensorTopics();  ///< our own names
};

struct PerceptionConfig {
  odometry::LidarModel lidar = odometry::vlp16();
  odometry::LoamConfig odometry;
  localization::EkfConfig localization;
  SensorTopics topics;
  /// UDP port at which the program receives a Velodyne LiDAR's packets, to publish its scans on topics.points
  /// itself; 0: a driver publishes them. Perception hears the topic either way.
  std::uint16_t velodyne_port = 0;
  DeviceConfig devices;
  bool odometry_uses_imu = true;    ///< angular velocity as rotation prior of LOAM
  bool odometry_uses_wheel = true;  ///< speed as prior of LOAM
  std::size_t waiting_scans = 50;   ///< scans that may wait for LOAM; the oldest gives way and is counted
};

}  // namespace fleetmap::agent
