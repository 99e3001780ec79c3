#pragma once

#include "fleetmap/config/robot_config.hpp"
#include "yaml_document.hpp"

namespace fleetmap::config {

/// The robot of a document of AGENT.yaml.
Result<RobotConfig> read_robot(Document& document);

}  // namespace fleetmap::config
