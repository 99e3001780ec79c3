#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::graph {

/// Configuration of the robust pose graph of the fleet (method `graph`).
struct FleetPlacementConfig {
  double gps_correlation_time = 60.0;  ///< s, of the slowly drifting part of G's error
  double gps_drift_share = 0.9;        ///< of the variance of G's position that drifts, (0, 1)
  double window_m = 30.0;              ///< m of path whose fixes count as one
  double alignment_floor_m =
      0.01;  ///< m, added in squares to C_ij: errors that registration cannot estimate from its residuals
  double alignment_floor_rad = 0.001;  ///< rad, likewise
  Status validate() const;
};

}  // namespace fleetmap::graph
