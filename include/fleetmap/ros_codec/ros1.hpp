#pragma once

#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::ros_codec {

/// A message as ROS 1 serialises it, as CDR of the ROS 2 type ("sensor_msgs/msg/Imu"), for decode(). Handles
/// PointCloud2, Imu, NavSatFix, Odometry, TFMessage, VelodyneScan and CustomMsg of the Livox drivers. Errors
/// for other types and for bytes that are not exactly such a message.
Result<Bytes> cdr_from_ros1(std::string_view type, ByteView message);

}  // namespace fleetmap::ros_codec
