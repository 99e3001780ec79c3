#pragma once

#include <string>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// `offset` (s), or the difference of two time scales (UTC, GPS time, TAI, time zones) that is so near that
/// drivers explain the rest.
double nearest_of_time_scales(double offset);
/// What such an offset means, in brackets with a blank before them; empty if it means nothing known. `stamp`
/// is one of the sensor's.
std::string reason_of(double offset, Stamp stamp);

}  // namespace fleetmap::sensor
