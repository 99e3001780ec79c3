#pragma once

#include <cstdint>
#include <optional>

#include "fleetmap/sensor/ouster_metadata.hpp"

namespace fleetmap::agent {

/// An Ouster LiDAR without a driver, live or in a capture.
struct OusterConfig {
  std::optional<sensor::OusterMetadata> metadata;  ///< needed for either
  /// UDP ports at which the program receives its packets, to publish its scans on topics.points and its IMU
  /// on topics.imu; 0: not received.
  std::uint16_t lidar_port = 0, imu_port = 0;
};

}  // namespace fleetmap::agent
