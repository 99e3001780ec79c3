#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/ouster_metadata.hpp"

namespace fleetmap::recording {

/// A file that ends in .pcap or .pcapng.
bool is_capture(const std::filesystem::path& path);
/// Reads the scans of one Ouster LiDAR, if its metadata are given or lie beside the capture (FILE.json), else
/// of one Velodyne LiDAR: of the first whose packets are found. Those of others are counted; other traffic is
/// passed over. Refuses a capture without any data packet.
Result<std::unique_ptr<Reader>> open_capture(const std::filesystem::path& path,
                                             const std::optional<sensor::OusterMetadata>& ouster,
                                             ScanContent content);

}  // namespace fleetmap::recording
