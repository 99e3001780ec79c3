#pragma once

#include "bag_file.hpp"

namespace fleetmap::recording {

/// A ROS 1 bag (format 2.0; chunks plain, bz2 or lz4), also one that was not closed or was cut.
Result<std::unique_ptr<BagFile>> open_ros1_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
