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
bus::Topic tf() { return {Link::kOnboard, "rt/tf", type_name::kTfMessage, "state"}; }
bus::Topic pose() { return {Link::kOnboard, "rt/fleetmap/pose", type_name::kPoseStamped, "state"}; }
bus::Topic fused_fix() { return {Link::kOnboard, "rt/fleetmap/fix", type_name::kNavSatFix, "state"}; }
bus::Topic path() { return {Link::kOnboard, "rt/fleetmap/path", type_name::kPath, "latched"}; }
bus::Topic diagnostics() { return {Link::kOnboard, "rt/diagnostics", type_name::kDiagnostics, "state"}; }
bus::Topic markers() { return {Link::kOnboard, "rt/fleetmap/markers", type_name::kMarkers, "latched"}; }
bus::Topic submaps() { return {Link::kOnboard, "rt/fleetmap/submaps", type_name::kPointCloud2, "state"}; }
bus::Topic map() { return {Link::kOnboard, "rt/fleetmap/map", type_name::kPointCloud2, "latched"}; }

std::vector<bus::Topic> outputs() {
  return {tf(),   tf_static(),   odometry(), pose(),    fused_fix(),
          path(), diagnostics(), markers(),  submaps(), map()};
}

}  // namespace fleetmap::ros_codec::topics
