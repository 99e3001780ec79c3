#pragma once

#include <string>

#include "fleetmap/core/time.hpp"

namespace fleetmap {

/// "2026-11-26T18:12:39.500Z" (RFC 3339), rounded down to milliseconds.
std::string to_utc(Stamp stamp);

}  // namespace fleetmap
