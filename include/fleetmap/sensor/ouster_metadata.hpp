#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/ouster_profile.hpp"

namespace fleetmap::sensor {

/// Description that an Ouster LiDAR (OS0, OS1, OS2) gives of its beams and its packets.
///
/// Frames, as the manual defines them: `lidar` has its x axis towards the connector, `sensor` has x ahead
/// (away from the connector), y left, z up and its origin in the middle of the bottom. Points are in
/// `sensor`.
struct OusterMetadata {
  std::string device;  ///< product line and serial number
  OusterProfile profile;
  std::size_t columns_per_frame = 0;   ///< of a full turn
  std::size_t columns_per_packet = 0;  ///< measurement blocks
  /// Unit vector of each beam at an encoder angle of 0, in `lidar`; its index is the beam's, 0 is the
  /// topmost.
  std::vector<Eigen::Vector3f> beams;
  Eigen::Vector3f beam_origin = Eigen::Vector3f::Zero();  ///< of all beams at an encoder angle of 0, m
  /// Columns that the device measures, both inclusive; a window across 0 is a full turn.
  std::size_t first_column = 0, last_column = 0;
  Pose T_sensor_lidar = Pose::Identity();
  Pose T_sensor_imu = Pose::Identity();
  std::uint16_t imu_port = 7503;  ///< UDP, to which the device sends the packets of its IMU
  bool has_imu_packets = true;    ///< in the format that is read (LEGACY)

  std::size_t lidar_packet_bytes() const;
  std::size_t packets_per_turn() const { return columns_per_frame / columns_per_packet; }
};

/// Reads the JSON of `GET /api/v1/sensor/metadata`, as Ouster's tools store it beside a capture: of firmware
/// 1.13 to 3.1, flat or in sections. Errors name the key and what was expected.
Result<OusterMetadata> read_ouster_metadata(std::string_view json);
/// The same of a file, which errors name.
Result<OusterMetadata> load_ouster_metadata(const std::filesystem::path& file);

}  // namespace fleetmap::sensor
