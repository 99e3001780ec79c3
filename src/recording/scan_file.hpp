#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"

namespace fleetmap::recording {

/// "0000000012.bin", ".pcd", and either with ".xz" after it.
bool is_scan_file(const std::filesystem::path& file);

/// A KITTI scan: .bin of float32 x, y, z, reflectance, or .pcd (binary or ascii) with x, y, z and perhaps
/// intensity. Neither has time or ring. Points without a return are dropped and counted, as are those at the
/// origin: files converted from .bin may end in such a mark.
Result<ros_codec::DecodedScan> read_scan_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
