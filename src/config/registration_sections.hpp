#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `spherize`, `registration` and `placement` of one agent.
void read_registration(Section& top, agent::AgentConfig& agent);

}  // namespace fleetmap::config
