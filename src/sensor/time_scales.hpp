#pragma once

#include <string>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// `offset` (s), or the difference of two time scales (UTC, GPS time, TAI, time zones) that is so near that
/// drivers explain the rest.
double nearest_of_time_scales(double offset);
/// Whether it has such a difference.
bool is_of_time_scales(double offset);
/// Explains such an offset, in brackets after a blank; empty for an unknown offset. `stamp` is one of the
/// sensor's.
std::string reason_of(double offset, Stamp stamp);

}  // namespace fleetmap::sensor
