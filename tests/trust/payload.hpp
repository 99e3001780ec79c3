#pragma once

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// What a robot sends, and the radio that it uses.
inline const Bytes kText{10, 20, 30, 40};
inline constexpr std::uint8_t kRadio = 1;

}  // namespace fleetmap::testing
