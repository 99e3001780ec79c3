#pragma once

#include <cstddef>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

/// Measurements and odometry as ROS 2 messages: what rmw_fastrtps puts on the wire and rosbag2 into a bag.
namespace fleetmap::ros_codec {

/// Odometry of base_link; on the wire a nav_msgs::msg::dds_::Odometry_ from "odom" to "base_link".
struct OdometryMsg {
  Stamp stamp;
  Pose T_odom_base = Pose::Identity();  ///< O
  /// Covariance of [translation (m), rotation (rad)], both in the axes of the odometry frame.
  Matrix6d covariance = Matrix6d::Zero();
};

/// Command to the base; on the wire a geometry_msgs::msg::dds_::Twist_.
struct VelocityCommand {
  double forward_speed = 0.0;  ///< m/s
  double yaw_rate = 0.0;       ///< rad/s, counter-clockwise
};

/// A decoded PointCloud2 and what was left out of it.
struct DecodedScan {
  sensor::Scan scan;
  std::size_t non_finite_points = 0;  ///< dropped: NaN or infinite coordinate
  std::size_t origin_points = 0;      ///< dropped: exactly (0, 0, 0), the mark of "no return"
  /// Point times were absolute in a clock more than 10 s away from the header's; they were counted from the
  /// earliest point instead.
  bool foreign_clock = false;
  /// Integer point times were too short a sweep in nanoseconds, and were taken for microseconds.
  bool times_in_microseconds = false;
};

/// PointCloud2 with x, y, z, intensity (float32), ring (uint16) if there, time (float32, s after the stamp)
/// if there.
Bytes encode(const sensor::Scan& scan, std::string_view frame_id = "lidar");
/// Without an orientation, orientation_covariance[0] is -1 (REP 145).
Bytes encode(const sensor::Imu& imu, std::string_view frame_id = "imu");
Bytes encode(const sensor::Fix& fix, std::string_view frame_id = "gps");
/// nav_msgs Odometry of which only the twist counts. No yaw rate: its variance (twist.covariance[35]) is -1.
Bytes encode(const sensor::Wheel& wheel);
/// Unknown fields are NaN or 0.
Bytes encode(const sensor::Battery& battery);
Bytes encode(const OdometryMsg& odometry);
Bytes encode(const VelocityCommand& command);

/// Reads a PointCloud2 of any driver: x, y, z float32 or float64 needed, in any order and at any offset;
/// optional `intensity` of any numeric type; `ring` or `channel` (uint8, uint16, uint32); point time in
/// `time`, `t`, `timestamp`, `offset_time` or `time_stamp` (float: s, or ns if beyond 1e12; integer: ns, or
/// us if the sweep would take less than 1 ms), relative to the header's stamp or absolute. Refuses data that
/// contradict height, width, point_step and row_step.
Result<DecodedScan> decode_scan(ByteView cdr);
/// The header's stamp of a PointCloud2, without reading anything else.
Result<Stamp> stamp_of_scan(ByteView cdr);

/// T is any type with an encode() above. Errors say which type and why.
template <class T>
Result<T> decode(ByteView cdr);

template <>
Result<sensor::Scan> decode(ByteView cdr);
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
