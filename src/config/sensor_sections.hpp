#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `topics`, `lidar`, `imu`, `gps`, `wheel` and `odometry` of one agent.
void read_perception(Section& top, agent::PerceptionConfig& perception);

}  // namespace fleetmap::config
