#pragma once

namespace fleetmap {

inline constexpr double kStandardGravity = 9.80665;  ///< m/s^2

}  // namespace fleetmap
