#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "builtin_interfaces.h"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::ros_codec {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// Stamps that ROS time cannot hold (before 1970, after 2038) are clamped to its ends.
inline builtin_interfaces::msg::dds_::Time_ to_ros(Stamp stamp) {
  const std::int64_t ns = std::clamp<std::int64_t>(to_ns(stamp), 0, INT32_MAX * kNsPerSecond);
  builtin_interfaces::msg::dds_::Time_ time;
  time.sec(static_cast<std::int32_t>(ns / kNsPerSecond));
  time.nanosec(static_cast<std::uint32_t>(ns % kNsPerSecond));
  return time;
}

inline Result<Stamp> from_ros(const builtin_interfaces::msg::dds_::Time_& time, const char* type) {
  if (time.sec() < 0 || time.nanosec() >= kNsPerSecond) {
    return failure(std::string(type) + ": header.stamp " + std::to_string(time.sec()) + " s " +
                   std::to_string(time.nanosec()) + " ns is not a time");
  }
  return stamp_from_ns(time.sec() * kNsPerSecond + time.nanosec());
}

}  // namespace fleetmap::ros_codec
