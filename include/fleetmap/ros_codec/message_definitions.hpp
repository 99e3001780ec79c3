#pragma once

#include <string>
#include <string_view>

namespace fleetmap::ros_codec {

/// Definition of a ROS 2 type ("sensor_msgs/msg/Imu") as .msg text, followed by those of all types that it
/// contains, as rosbag2 writes it into MCAP ("ros2msg"). Empty for types that are not in idl/ros2.
std::string message_definition(std::string_view type);

}  // namespace fleetmap::ros_codec
