#pragma once

#include <cstddef>
#include <filesystem>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Reads a .ply or .pcd file (ascii, binary, compressed binary): fields x, y, z of any numeric type, and
/// `intensity` where there is one. Other fields are skipped. Errors name the file. Non-finite points are kept
/// as they are. Written by hand for the reasons in cloud_writer.hpp; tests compare it with pcl_io.
Result<PointCloud> read_cloud(const std::filesystem::path& file);

/// A cloud of which every k-th point was read.
struct ThinnedCloud {
  PointCloud cloud;
  std::size_t points_in_file = 0;
};
/// As read_cloud(), but of a file with more points than `max_points` only every k-th one, k as small as
/// possible. Binary files are mapped and not loaded, so that memory is bounded by `max_points`; ascii and
/// compressed files are loaded whole.
Result<ThinnedCloud> read_thinned_cloud(const std::filesystem::path& file, std::size_t max_points);

/// Writes a binary .ply or .pcd (float32 x y z, and intensity where the cloud has it). The file appears whole
/// or not at all. Errors name the file.
Status write_cloud(const std::filesystem::path& file, const PointCloud& cloud);

}  // namespace fleetmap::cloud
