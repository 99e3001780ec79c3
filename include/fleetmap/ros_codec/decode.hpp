#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

/// Measurements and odometry as ROS 2 messages: what rmw_fastrtps puts on the wire and rosbag2 into a bag.
namespace fleetmap::ros_codec {

/// T is any type with an encode() in this folder. Errors name the type and the cause.
template <class T>
Result<T> decode(ByteView cdr);

}  // namespace fleetmap::ros_codec
