#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// The shape of the ground. Amplitudes are one standard deviation, about.
struct TerrainConfig {
  double rolling_amplitude = 0.4;    ///< m, of the hills
  double rolling_wavelength = 80.0;  ///< m, from hill to hill
  double rough_amplitude = 0.02;     ///< m, of tracks, tufts and clods
  double rough_wavelength = 3.0;     ///< m
  double slope_east_rad = 0.0;       ///< rad, of the whole site, rising to the east
  double slope_north_rad = 0.0;      ///< rad
  /// Also that the steepest ground to be expected stays below 45 deg.
  Status validate() const;
};

}  // namespace fleetmap::sim
