#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace fleetmap {

/// Time is integer nanoseconds everywhere; a Stamp counts from the Unix epoch (or from 0 in virtual time).
using Duration = std::chrono::nanoseconds;
using Stamp = std::chrono::time_point<std::chrono::system_clock, Duration>;

constexpr Stamp stamp_from_ns(std::int64_t ns) { return Stamp{Duration{ns}}; }
constexpr std::int64_t to_ns(Stamp stamp) { return stamp.time_since_epoch().count(); }

/// Seconds as a double, for arithmetic with physical quantities only.
constexpr double to_seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }
constexpr double to_seconds(Stamp stamp) { return to_seconds(stamp.time_since_epoch()); }
inline Duration from_seconds(double seconds) { return Duration{std::llround(seconds * 1e9)}; }

}  // namespace fleetmap
