#pragma once

#include <string>
#include <string_view>

namespace fleetmap::recording {

/// "rt/points" -> "/points"; other names get a leading slash.
std::string ros_topic(std::string_view topic);
/// "sensor_msgs::msg::dds_::Imu_" -> "sensor_msgs/msg/Imu"; "fleetmap::msg::Node" -> "fleetmap/msg/Node".
std::string ros_type(std::string_view type);

}  // namespace fleetmap::recording
