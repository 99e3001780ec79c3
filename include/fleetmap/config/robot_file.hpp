#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// The sensor and odometry settings alone, from an agent's or a fleet's file (its first agent) or, without a
/// file, the defaults.
Result<RobotConfig> load_sensors(const std::optional<std::filesystem::path>& file,
                                 const std::vector<Override>& overrides);

}  // namespace fleetmap::config
