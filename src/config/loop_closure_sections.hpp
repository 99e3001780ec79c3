#pragma once

#include "fleetmap/agent/agent_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `own_path`: pairs of nodes of the robot's own path.
void read_own_path(Section& top, loop_closure::OwnPathConfig& own_path);
/// `proximity` and `loop_candidates`: pairs of nodes of different robots.
void read_loop_candidates(Section& top, loop_closure::CandidateConfig& closure);

}  // namespace fleetmap::config
