#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::place {

/// The number by which the covariance of the EKF enters Eq. 1.
enum class Uncertainty {
  variance,  ///< the larger eigenvalue of the horizontal covariance, m^2: Eq. 1 as the paper prints it
  sigma,     ///< its root, m
};
const char* to_string(Uncertainty uncertainty);

/// Eq. 1: r^i = clamp(C_ekf^i * r, r_min, r_max).
struct ProximityConfig {
  Uncertainty uncertainty = Uncertainty::sigma;
  double radius_scale = 10.0;  ///< r: metres of search radius per unit of C_ekf^i
  double min_radius = 20.0;    ///< m, r_min of the paper's experiments
  double max_radius = 30.0;    ///< m, r_max of the paper's experiments

  Status validate() const;
};

}  // namespace fleetmap::place
