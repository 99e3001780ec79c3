#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// A folder with metadata.yaml or files of rosbag2, or one such file: .db3, .mcap, either with
/// .zstd, or a ROS 1 .bag.
bool is_bag(const std::filesystem::path& path);
Result<std::unique_ptr<Reader>> open_bag(const std::filesystem::path& path, const ReaderConfig& config,
                                         ScanContent content);

}  // namespace fleetmap::recording
