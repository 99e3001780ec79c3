#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// A folder with velodyne_points.
bool looks_like_kitti(const std::filesystem::path& path);
Result<std::unique_ptr<Reader>> open_kitti(const std::filesystem::path& path, const KittiConfig& config);

}  // namespace fleetmap::recording
