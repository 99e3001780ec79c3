#pragma once

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `robot` of an agent: its robot in the twin. The sensors' mounts are those of the agent's own `lidar`,
/// `imu` and `gps`, so that twin and estimator agree. Without `robot.lidar` it carries a VLP-16 (or the LiDAR
/// of `config`), and without `robot.seed` its seed follows from the agent's id.
void read_robot_twin(Section& agent_section, sim::RobotTwinConfig& config,
                     std::vector<SwitchedOff>& switched_off);

/// `world`, `mission` and `max_time` of a fleet's file; empty without `world`.
std::optional<TwinConfig> read_twin(Section& top);
/// Sets the odometry's model and period to those of the twin's LiDAR where the configuration has none.
void suit_estimator(FleetConfig::Member& member, Section lidar);

}  // namespace fleetmap::config
