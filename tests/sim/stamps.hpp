#pragma once

#include "fleetmap/core/time.hpp"

namespace fleetmap::sim {

/// So many seconds after the beginning of virtual time.
inline Stamp at(double seconds) { return Stamp{from_seconds(seconds)}; }

}  // namespace fleetmap::sim
