#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

/// How far odometry is trusted between two nodes: standard deviations that grow with the distance.
struct OdometryUncertaintyConfig {
  double translation_share = 0.002;    ///< m a metre, along each axis
  double translation_floor_m = 0.01;   ///< m, of scan matching
  double rotation_rad_per_m = 8.7e-4;  ///< 0.05 deg a metre, about each axis
  double rotation_floor_rad = 5e-4;    ///< rad
  Status validate() const;
};

/// Covariance of the odometry over one node interval, right tangent of T_previous_this: [m, rad].
Matrix6d odometry_covariance(const Pose& T_previous_this, const OdometryUncertaintyConfig& config);

}  // namespace fleetmap::agent
