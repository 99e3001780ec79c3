#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// A file that ends in .pcap or .pcapng.
bool is_capture(const std::filesystem::path& path);
/// Reads the scans of one Velodyne LiDAR, of the first whose packets are found. Those of others are counted;
/// other traffic is passed over. Refuses a capture without any data packet.
Result<std::unique_ptr<Reader>> open_capture(const std::filesystem::path& path, ScanContent content);

}  // namespace fleetmap::recording
