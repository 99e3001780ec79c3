#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <variant>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/sensor/mavlink_frames.hpp"

namespace fleetmap::sensor {

/// Types of messages of MAVLink's common.xml. For heartbeats and attitudes in angles only the checksums are
/// used, to find frames.
inline constexpr std::uint32_t kMavlinkHeartbeat = 0, kMavlinkSystemTime = 2, kMavlinkGpsRawInt = 24,
                               kMavlinkScaledImu = 26, kMavlinkAttitude = 30, kMavlinkAttitudeQuaternion = 31,
                               kMavlinkHighresImu = 105, kMavlinkTimesync = 111;

/// A time as messages state it: since the device was switched on, or since the Unix epoch.
struct MavlinkTime {
  Duration since{};
  bool is_unix = false;
};

/// SYSTEM_TIME: UTC and time since the device's start.
struct MavlinkSystemTime {
  std::optional<Duration> unix_time;  ///< empty until the device has one from GPS
  Duration boot{};
};
/// GPS_RAW_INT: a fix in WGS84.
struct MavlinkGps {
  MavlinkTime time;
  int fix_type = 0;     ///< GPS_FIX_TYPE: 2 is a fix without altitude, 3 and above one with it
  GeoPoint position{};  ///< altitude above the ellipsoid, if that is stated; else above sea level
  bool has_ellipsoid = false;
  double sigma_h = 0.0, sigma_v = 0.0;  ///< m; 0 where the device does not state them
};
/// ATTITUDE_QUATERNION: rotation from the body (FRD) to NED.
struct MavlinkAttitude {
  Duration boot{};
  Eigen::Quaterniond q_ned_frd = Eigen::Quaterniond::Identity();
};
/// SCALED_IMU or HIGHRES_IMU: a sample in the body's axes.
struct MavlinkImu {
  MavlinkTime time;
  bool high_resolution = false;
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero(),
                  angular_velocity = Eigen::Vector3d::Zero();  ///< m/s^2, rad/s; x forward, y right, z down
};
/// TIMESYNC: a request for the device's time, or its answer.
struct MavlinkTimesync {
  Duration device{};  ///< 0 in a request
  Duration asked{};   ///< by the asker's clock
};
using MavlinkMessage =
    std::variant<MavlinkSystemTime, MavlinkGps, MavlinkAttitude, MavlinkImu, MavlinkTimesync>;

/// Empty for other types, for times that no clock shows (beyond 2100), for numbers that are not finite, and
/// for a HIGHRES_IMU that is of a second IMU or updates not all of acceleration and angular velocity.
std::optional<MavlinkMessage> decode_mavlink(const MavlinkFrame& frame);

/// A request to which a device answers with its time.
Bytes encode_mavlink(const MavlinkTimesync& message, std::uint8_t sequence);

}  // namespace fleetmap::sensor
