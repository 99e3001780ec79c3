#pragma once

#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// Reads a list of robots' names; leaves `ids` as it is if the key is absent.
void read_names(Section& section, const char* key, std::vector<AgentId>& ids);
/// `long_range` and `short_range` of one agent.
void read_exchange(Section& top, agent::AgentConfig& agent);

}  // namespace fleetmap::config
