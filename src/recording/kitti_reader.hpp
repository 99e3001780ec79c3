#pragma once

#include <filesystem>
#include <memory>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// KITTI's raw layout (velodyne_points, oxts), that of its odometry benchmark (velodyne, times.txt), or a
/// bare folder of scans.
bool has_kitti_layout(const std::filesystem::path& path);
/// True for a path with such a content.
Result<std::unique_ptr<Reader>> open_kitti(const std::filesystem::path& path, const KittiConfig& config,
                                           ScanContent content = ScanContent::kPoints);

}  // namespace fleetmap::recording
