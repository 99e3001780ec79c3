#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/sensor/mavlink_messages.hpp"

namespace fleetmap::testing {

/// The fields of a message in the order in which they are sent.
class MavlinkPayload {
 public:
  template <class T>
  MavlinkPayload& add(T value) {
    std::uint64_t bits = 0;
    if constexpr (std::is_same_v<T, float>) {
      bits = std::bit_cast<std::uint32_t>(value);
    } else {
      bits = static_cast<std::uint64_t>(value);
    }
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes_.push_back(static_cast<std::uint8_t>(bits >> 8 * k));
    return *this;
  }
  Bytes frame(std::uint32_t id) const { return sensor::mavlink_frame(id, bytes_, 0); }

 private:
  Bytes bytes_;
};

/// Vectors: x forward, y right, z down.
inline Bytes highres_imu(std::uint64_t microseconds, const Eigen::Vector3d& force,
                         const Eigen::Vector3d& rate) {
  MavlinkPayload payload;
  payload.add(microseconds);
  for (const Eigen::Vector3d& vector : {force, rate}) {
    for (int axis = 0; axis < 3; ++axis) payload.add(static_cast<float>(vector[axis]));
  }
  for (int k = 0; k < 7; ++k) payload.add(0.0f);
  return payload.add(std::uint16_t{0x3f}).frame(sensor::kMavlinkHighresImu);
}

/// At rest and level.
inline Bytes scaled_imu(std::uint32_t milliseconds) {
  MavlinkPayload payload;
  payload.add(milliseconds);
  for (const int value : {0, 0, -1000, 0, 0, 0, 0, 0, 0}) payload.add(static_cast<std::int16_t>(value));
  return payload.frame(sensor::kMavlinkScaledImu);
}

inline Bytes attitude_quaternion(std::uint32_t milliseconds, const Eigen::Quaterniond& q_ned_frd) {
  MavlinkPayload payload;
  payload.add(milliseconds);
  const Eigen::Quaterniond& q = q_ned_frd;
  for (const double value : {q.w(), q.x(), q.y(), q.z(), 0.0, 0.0, 0.0})
    payload.add(static_cast<float>(value));
  return payload.frame(sensor::kMavlinkAttitudeQuaternion);
}

inline Bytes system_time(std::uint64_t unix_us, std::uint32_t boot_ms) {
  return MavlinkPayload().add(unix_us).add(boot_ms).frame(sensor::kMavlinkSystemTime);
}

/// 39 N 3 W, `above_ellipsoid` mm above the ellipsoid (0: not stated) and 600 m above the sea; standard
/// deviations of 0.5 and 0.9 m.
inline Bytes gps_raw_int(std::uint64_t microseconds, int fix_type, std::int32_t above_ellipsoid = 650'000) {
  return MavlinkPayload()
      .add(microseconds)
      .add(std::int32_t{390000000})
      .add(std::int32_t{-30000000})
      .add(std::int32_t{600000})
      .add(std::uint64_t{0})
      .add(static_cast<std::uint8_t>(fix_type))
      .add(std::uint8_t{12})
      .add(above_ellipsoid)
      .add(std::uint32_t{500})
      .add(std::uint32_t{900})
      .frame(sensor::kMavlinkGpsRawInt);
}

}  // namespace fleetmap::testing
