#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "fleetmap/core/time.hpp"

namespace fleetmap {

/// By the computer's clock.
inline Stamp system_now() { return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now()); }

/// "2026-11-26T18:12:39.500Z" (RFC 3339), rounded down to milliseconds.
std::string to_utc(Stamp stamp);

/// Reads a time written so, with any number of decimals or none, of the years 1970 to 2261. Empty for other
/// texts.
std::optional<Stamp> from_utc(std::string_view text);

}  // namespace fleetmap
