#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// A folder with metadata.yaml or files of rosbag2, or one such file: .db3, .mcap, or either with .zstd.
bool looks_like_bag(const std::filesystem::path& path);
Result<std::unique_ptr<Reader>> open_bag(const std::filesystem::path& path, const Topics& topics,
                                         ScanContent content);

}  // namespace fleetmap::recording
