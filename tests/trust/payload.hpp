#pragma once

#include <cstdint>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// Payload of a datagram, and the radio that carries it.
inline const Bytes kText{10, 20, 30, 40};
inline constexpr std::uint8_t kRadio = 1;

}  // namespace fleetmap::testing
