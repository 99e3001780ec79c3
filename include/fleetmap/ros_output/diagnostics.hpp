#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/monitor/live_status.hpp"
#include "fleetmap/ros_codec/diagnostics.hpp"

namespace fleetmap::ros_output {

/// State of a robot's sensors and of the fleet, as the robot has it.
struct RobotState {
  AgentId self;
  Stamp stamp;
  std::vector<std::string> findings;  ///< of the checks of the sensors, each with its remedy
  std::vector<monitor::SensorNow> sensors;
  std::vector<monitor::RobotNow> robots;
  std::optional<double> lost_after_s;  ///< a robot silent for longer is stale; empty: hearing is not known
  std::vector<std::string> notes;      ///< of the checks: what was corrected exactly
};

/// One status for the checks of the sensors, one a sensor that was heard, one a robot.
ros_codec::DiagnosticsMsg diagnostics(const RobotState& state);

}  // namespace fleetmap::ros_output
