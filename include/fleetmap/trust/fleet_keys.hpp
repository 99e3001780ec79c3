#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::trust {

using SecretKey = std::array<std::uint8_t, 32>;

/// The symmetric keys that all members share, by epoch. The last one seals; older ones only serve to name the
/// members that still use them.
using FleetKeys = std::map<std::uint16_t, SecretKey>;

FleetKeys with_new_epoch(FleetKeys keys);

/// A line an epoch: its number and 64 hexadecimal digits. Lines that begin with # are comments.
std::string to_text(const FleetKeys& keys);

Result<FleetKeys> parse_fleet_keys(const std::string& text);

}  // namespace fleetmap::trust
