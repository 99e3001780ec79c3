#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/config/recording_config.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/ros_output/ros_output_config.hpp"

namespace fleetmap::config {

/// The robot's body, by which its own scan is divided into ground and obstacles.
struct RobotShape {
  double radius = 0.35;      ///< m, around base_link
  double base_height = 0.1;  ///< m, of base_link above the ground
};

/// A mission on the drawing of a site, for a robot without a twin.
struct RobotMission {
  planning::MissionConfig settings;
  std::vector<planning::RobotAbility> fleet;  ///< of every robot; their starts are the drawing's
  RobotShape shape;                           ///< of this robot
  std::string at;                             ///< file, line and key, for messages
};

/// One robot over DDS: AGENT.yaml.
struct RobotConfig {
  agent::AgentConfig agent;
  std::optional<RobotMission> mission;
  bus::DdsBusConfig dds;
  std::optional<RecordingConfig> recording;
  ros_output::RosOutputConfig ros;
};

}  // namespace fleetmap::config
