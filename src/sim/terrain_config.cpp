#include "fleetmap/sim/terrain_config.hpp"

#include <cmath>
#include <numbers>

namespace fleetmap::sim {

Status TerrainConfig::validate() const {
  if (!(rolling_amplitude >= 0.0 && rolling_amplitude <= 100.0))
    return failure("rolling_amplitude must be from 0 to 100 m");
  if (!(rolling_wavelength >= 5.0 && rolling_wavelength <= 1e5))
    return failure("rolling_wavelength must be from 5 to 1e5 m");
  if (!(rough_amplitude >= 0.0 && rough_amplitude <= 1.0))
    return failure("rough_amplitude must be from 0 to 1 m");
  if (!(rough_wavelength >= 0.5 && rough_wavelength <= 100.0))
    return failure("rough_wavelength must be from 0.5 to 100 m");
  for (const double slope : {slope_east_rad, slope_north_rad}) {
    if (!(std::abs(slope) <= std::numbers::pi / 6.0)) return failure("slopes must be from -30 to 30 deg");
  }
  const auto steepest = [](double amplitude, double wavelength) { return 24.0 * amplitude / wavelength; };
  const double slope = steepest(rolling_amplitude, rolling_wavelength) +
                       steepest(rough_amplitude, rough_wavelength) +
                       std::hypot(std::tan(slope_east_rad), std::tan(slope_north_rad));
  if (slope > 1.0)
    return failure(
        "the ground would be steeper than 45 deg in places; lower an amplitude or a slope, or "
        "lengthen a wavelength");
  return {};
}

}  // namespace fleetmap::sim
