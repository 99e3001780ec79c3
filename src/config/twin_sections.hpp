#pragma once

#include "fleetmap/sim/robot_twin.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// The key `robot` of an agent: the robot that stands for it in the twin. The sensors' mounts are those of
/// the agent's own `lidar`, `imu` and `gps`, so that twin and estimator agree; without `robot.lidar` it
/// carries a VLP-16 (or what `config` says), and without `robot.seed` its seed follows from the agent's id.
void read_robot_twin(Section& agent_section, sim::RobotTwinConfig& config,
                     std::vector<SwitchedOff>& switched_off);

}  // namespace fleetmap::config
