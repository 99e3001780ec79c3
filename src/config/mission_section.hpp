#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `mission`, at the top of AGENT.yaml or FLEET.yaml: what the robots are to drive. Problems are noted in the
/// document.
void read_mission(Section& top, planning::MissionConfig& mission);

}  // namespace fleetmap::config
