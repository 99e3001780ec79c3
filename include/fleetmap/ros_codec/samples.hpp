#pragma once

#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/ros_codec/decode.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::ros_codec {

/// Odometry of base_link; on the wire a nav_msgs::msg::dds_::Odometry_ from "odom" to "base_link".
struct OdometryMsg {
  Stamp stamp;
  Pose T_odom_base = Pose::Identity();  ///< O
  /// Covariance of [translation (m), rotation (rad)], both in the axes of the odometry frame.
  Matrix6d covariance = Matrix6d::Zero();
  Vector6d twist = Vector6d::Zero();             ///< of base_link in base_link, [m/s, rad/s]
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< in base_link
};

/// Command to the base; on the wire a geometry_msgs::msg::dds_::Twist_.
struct VelocityCommand {
  double forward_speed = 0.0;  ///< m/s
  double yaw_rate = 0.0;       ///< rad/s, counter-clockwise
};

/// Without an orientation, orientation_covariance[0] is -1 (REP 145).
Bytes encode(const sensor::Imu& imu, std::string_view frame_id = "imu");
Bytes encode(const sensor::Fix& fix, std::string_view frame_id = "gps");
/// nav_msgs Odometry of which only the twist counts. No yaw rate: its variance (twist.covariance[35]) is -1.
Bytes encode(const sensor::Wheel& wheel);
/// Unknown fields are NaN or 0.
Bytes encode(const sensor::Battery& battery);
Bytes encode(const OdometryMsg& odometry);
Bytes encode(const VelocityCommand& command);

/// Refuses non-finite rates and accelerations; an orientation that is no rotation counts as none.
template <>
Result<sensor::Imu> decode(ByteView cdr);
/// No fix, NaN or off the Earth: `valid` is false. The covariance is passed on as reported.
template <>
Result<sensor::Fix> decode(ByteView cdr);
template <>
Result<sensor::Wheel> decode(ByteView cdr);
template <>
Result<OdometryMsg> decode(ByteView cdr);
template <>
Result<VelocityCommand> decode(ByteView cdr);

/// Refuses a percentage that is not in [0, 1].
template <>
Result<sensor::Battery> decode(ByteView cdr);

}  // namespace fleetmap::ros_codec
