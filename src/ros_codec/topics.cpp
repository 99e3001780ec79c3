#include "fleetmap/ros_codec/topics.hpp"

#include "type_names.hpp"

namespace fleetmap::ros_codec::topics {

using bus::Link;

bus::Topic points() { return {Link::kOnboard, "rt/points", type_name::kPointCloud2, "sensor"}; }
bus::Topic imu() { return {Link::kOnboard, "rt/imu", type_name::kImu, "sensor"}; }
bus::Topic fix() { return {Link::kOnboard, "rt/fix", type_name::kNavSatFix, "sensor"}; }
bus::Topic wheel_odometry() { return {Link::kOnboard, "rt/wheel_odometry", type_name::kOdometry, "sensor"}; }
bus::Topic tf_static() { return {Link::kOnboard, "rt/tf_static", type_name::kTfMessage, "latched"}; }
bus::Topic battery() { return {Link::kOnboard, "rt/battery_state", type_name::kBatteryState, "sensor"}; }
bus::Topic odometry() { return {Link::kOnboard, "rt/odometry", type_name::kOdometry, "state"}; }
bus::Topic cmd_vel() { return {Link::kOnboard, "rt/cmd_vel", type_name::kTwist, "state"}; }

}  // namespace fleetmap::ros_codec::topics
