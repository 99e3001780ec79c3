#pragma once

#include "correlation_grid.hpp"
#include "fleetmap/registration/prepared_cloud.hpp"
#include "paper_registration.hpp"
#include "surfel_icp.hpp"
#include "surfels.hpp"

namespace fleetmap::registration {

/// All but `features` is of the correlative search, and in the levelled frame: the cloud's origin, z against
/// gravity.
struct PreparedCloud::Data {
  FeatureCloud features;  ///< of method `paper`, in the cloud's own frame
  Eigen::Matrix3d R_level_cloud = Eigen::Matrix3d::Identity();
  SurfelMap surfels;
  CorrelationGrid flat;
  /// m, root mean square distance of the points from the surfels of their own cloud: noise, rounding,
  /// roughness.
  double noise_m = 0.0;
  MovingPoints all;     ///< points of the thinned cloud
  MovingPoints fine;    ///< evenly picked
  MovingPoints middle;  ///< fewer
  MovingPoints coarse;  ///< few
};

}  // namespace fleetmap::registration
