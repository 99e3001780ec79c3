#pragma once

#include <string>
#include <vector>

#include "command_result.hpp"
#include "fleetmap/config/robot_config.hpp"

namespace fleetmap::apps {

/// Settings of the file of -c, the defaults if it is empty, with the values of --set.
CommandResult<config::RobotConfig> sensor_settings(const std::string& file,
                                                   const std::vector<std::string>& set);

}  // namespace fleetmap::apps
