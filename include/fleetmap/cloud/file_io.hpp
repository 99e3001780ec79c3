#pragma once

#include <filesystem>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Reads a .ply or .pcd file (ascii, binary, compressed binary): fields x, y, z of any numeric type, and
/// `intensity` where there is one. Other fields are skipped. Errors name the file. Non-finite points are kept
/// as they are. Written by hand for the reasons in cloud_writer.hpp; tests compare it with pcl_io.
Result<PointCloud> read_cloud(const std::filesystem::path& file);

/// Writes a binary .ply or .pcd (float32 x y z, and intensity where the cloud has it). The file appears whole
/// or not at all. Errors name the file.
Status write_cloud(const std::filesystem::path& file, const PointCloud& cloud);

}  // namespace fleetmap::cloud
