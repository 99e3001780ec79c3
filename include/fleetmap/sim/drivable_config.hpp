#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Rules by which a mesh becomes drivable ground.
struct DrivableConfig {
  double cell = 0.25;            ///< m, of the grid of heights and obstacles
  double robot_height = 0.9;     ///< m: what hangs lower than this above the ground is in the way
  double step_height = 0.15;     ///< m: what is lower than this is driven over
  double max_slope_rad = 0.436;  ///< rad (25 deg): steeper ground is in the way
  Status validate() const;
};

}  // namespace fleetmap::sim
