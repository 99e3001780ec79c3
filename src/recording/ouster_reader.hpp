#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/ouster_metadata.hpp"

namespace fleetmap::recording {

/// Reads scans and IMU samples of one Ouster LiDAR from a capture, of the first whose packets are as its
/// metadata state; those of others are counted. The IMU is what the same address sends to the metadata's
/// udp_port_imu. Refuses a capture without any lidar packet.
Result<std::unique_ptr<Reader>> open_ouster_capture(const std::filesystem::path& path,
                                                    const sensor::OusterMetadata& metadata,
                                                    ScanContent content);

}  // namespace fleetmap::recording
