#pragma once

#include <numbers>

namespace fleetmap {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

}  // namespace fleetmap
