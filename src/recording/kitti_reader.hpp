#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// KITTI's raw layout (velodyne_points, oxts), that of its odometry benchmark (velodyne, times.txt), or a
/// bare folder of scans.
bool looks_like_kitti(const std::filesystem::path& path);
/// Of a path that looks like it.
Result<std::unique_ptr<Reader>> open_kitti(const std::filesystem::path& path, const KittiConfig& config);

}  // namespace fleetmap::recording
