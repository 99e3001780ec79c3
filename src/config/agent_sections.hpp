#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// The keys that describe one agent, at the top of AGENT.yaml or in a list entry of FLEET.yaml (laid on
/// `defaults`).
void read_agent(Section& top, agent::AgentConfig& agent);

}  // namespace fleetmap::config
