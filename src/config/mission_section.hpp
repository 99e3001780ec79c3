#pragma once

#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/twin_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `mission` at the top of FLEET.yaml: what the robots drive, and how hard the twin makes it. Problems are
/// noted in the document.
void read_mission(Section& top, TwinConfig& twin);
/// Only what a fleet's and an agent's file have in common.
void read_mission_settings(Section& top, planning::MissionConfig& mission);
/// The same of AGENT.yaml, whose robot drives on a drawing (`file`) without a twin; nothing if there is no
/// `mission`. The abilities of all robots of `fleet` follow from `speed` and `robots`.
std::optional<RobotMission> read_mission(Section& top, const agent::AgentConfig& agent);

}  // namespace fleetmap::config
