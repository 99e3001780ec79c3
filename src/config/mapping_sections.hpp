#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `nodes`, `submap` and `map` of one agent.
void read_mapping(Section& top, agent::AgentConfig& agent);

}  // namespace fleetmap::config
