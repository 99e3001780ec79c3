#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/lidar.hpp"

namespace fleetmap::config {

/// A LiDAR's data sheet as YAML (config/sensors). Fails with all that is wrong, each with file and line. The
/// spec is valid, and its `model` is one that the odometry knows.
Result<sim::LidarSpec> load_lidar_spec(const std::filesystem::path& file);

}  // namespace fleetmap::config
