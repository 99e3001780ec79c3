#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `keys`: the robot's folder of keys, or in a fleet's file the folder that holds one for each robot.
void read_keys(Section& top, bool of_fleet, agent::AgentConfig& agent, bus::DdsBusConfig& dds);

}  // namespace fleetmap::config
