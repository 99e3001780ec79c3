#pragma once

#include <cmath>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sim {

/// So many seconds after the beginning of virtual time.
inline Stamp at(double seconds) { return stamp_from_ns(std::llround(seconds * 1e9)); }

}  // namespace fleetmap::sim
