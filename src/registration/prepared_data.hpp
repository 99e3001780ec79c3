#pragma once

#include "flat_map.hpp"
#include "fleetmap/registration/prepared_cloud.hpp"
#include "surfel_icp.hpp"
#include "surfels.hpp"

namespace fleetmap::registration {

/// Everything is in the levelled frame: the cloud's origin, z against gravity.
struct PreparedCloud::Data {
  Eigen::Matrix3d R_level_cloud = Eigen::Matrix3d::Identity();
  SurfelMap surfels;
  FlatMap flat;
  /// m, root mean square distance of the points from the surfels of their own cloud: noise, rounding,
  /// roughness.
  double noise_m = 0.0;
  MovingPoints all;     ///< points of the thinned cloud
  MovingPoints fine;    ///< evenly picked
  MovingPoints middle;  ///< fewer
  MovingPoints coarse;  ///< few
};

}  // namespace fleetmap::registration
