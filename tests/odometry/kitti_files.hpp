#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::testing {

/// The .pcd.xz frames of a KITTI raw drive in order.
std::vector<std::filesystem::path> kitti_frames(const std::filesystem::path& drive);
/// One frame (fields x y z intensity, binary, xz-compressed) at frame * 0.1 s, without the sentinel at its
/// end; empty if it cannot be read.
std::optional<sensor::Scan> read_kitti_scan(const std::filesystem::path& file, int frame);
/// Angular rates of the drive's OXTS records in the Velodyne's frame.
std::vector<sensor::Imu> read_kitti_gyro(const std::filesystem::path& drive);
/// Forward speed of the drive's OXTS records.
std::vector<sensor::Wheel> read_kitti_speed(const std::filesystem::path& drive);
/// TUM lines (stamp x y z qx qy qz qw) as poses by frame = round(stamp / 0.1 s).
std::map<int, Pose> read_tum_by_frame(const std::filesystem::path& file);

}  // namespace fleetmap::testing
