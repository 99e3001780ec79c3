#pragma once

#include <array>
#include <cstdint>

namespace fleetmap {

/// A maker's signature of an item: Ed25519, RFC 8032.
using Signature = std::array<std::uint8_t, 64>;

}  // namespace fleetmap
