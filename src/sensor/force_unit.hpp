#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "standard_gravity.hpp"

namespace fleetmap::sensor {

/// Unit of a specific force whose norm is that of gravity.
struct ForceUnit {
  const char* name;
  double scale;
};
inline constexpr std::array kForceUnits{ForceUnit{"m/s^2", 1.0}, ForceUnit{"g", kStandardGravity},
                                        ForceUnit{"milli-g", 1e-3 * kStandardGravity}};

inline const ForceUnit* force_unit_of(double norm) {
  const auto fits = [norm](const ForceUnit& unit) {
    return std::abs(norm * unit.scale - kStandardGravity) < 0.35 * kStandardGravity;
  };
  const auto* unit = std::ranges::find_if(kForceUnits, fits);
  return unit == kForceUnits.end() ? nullptr : unit;
}

}  // namespace fleetmap::sensor
