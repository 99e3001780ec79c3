#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/lidar.hpp"

namespace fleetmap::config {

/// A LiDAR's data sheet as YAML (config/sensors). Fails with all problems, each with file and line. The spec
/// is valid, and the odometry has its `model`.
Result<sim::LidarSpec> load_lidar_spec(const std::filesystem::path& file);

}  // namespace fleetmap::config
