#pragma once

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// Beginning of a made-up drive.
inline constexpr Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);

/// So many seconds after the beginning.
inline Stamp at(double seconds) { return kStart + from_seconds(seconds); }

/// The start of a device whose clock counts from it.
inline constexpr Stamp kSwitchedOn = stamp_from_ns(1'795'630'000'000'000'000);

}  // namespace fleetmap::sensor
