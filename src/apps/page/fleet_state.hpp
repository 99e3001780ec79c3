#pragma once

#include <map>
#include <string>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "robot/link_log.hpp"
#include "robot_states.hpp"

namespace fleetmap::apps {

/// Problems of a robot whose agent runs in this process, in words.
std::vector<std::string> problems_of(const agent::Agent& agent, Stamp now);
/// Failures since it started, in words; they may be over.
std::vector<std::string> totals_of(const agent::Agent& agent);

/// s, so long a robot may be silent before this agent counts it as lost.
double lost_after(const agent::Agent& agent);

/// The fleet as an agent has heard of it. `last_heard`: on its radios.
FleetState fleet_state(const agent::Agent& agent, const std::map<LinkLog::Source, LinkLog::Heard>& last_heard,
                       Stamp now);

}  // namespace fleetmap::apps
