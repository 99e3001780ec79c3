#pragma once

#include <Eigen/Core>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Limits of the surfaces that count as ground.
struct GroundConfig {
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();  ///< against gravity, in the cloud's frame, any length
  float cell_m = 1.0f;         ///< m, edge of the cells that each hold one piece of ground surface
  float thickness_m = 0.2f;    ///< m, points this close above the surface belong to it
  float step_m = 0.2f;         ///< m, roughness: height step between neighbouring cells that is still ground
  float max_slope_rad = 0.7f;  ///< rad, steeper is no ground
  float max_slope_change_rad = 0.25f;  ///< rad, change of slope from cell to cell that is still ground
  float min_area_m2 = 12.0f;           ///< m^2, smaller connected surfaces are no ground
  Status validate() const;
};

}  // namespace fleetmap::cloud
