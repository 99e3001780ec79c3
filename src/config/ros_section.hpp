#pragma once

#include "fleetmap/ros_output/ros_output_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `ros`: what the robot publishes for ROS 2's tools.
ros_output::RosOutputConfig read_ros(Section& top);

}  // namespace fleetmap::config
