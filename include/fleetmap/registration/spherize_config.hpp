#pragma once

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/fit_config.hpp"
#include "fleetmap/cloud/ground.hpp"
#include "fleetmap/cloud/outliers.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::registration {

/// Configuration of the spherization of a cloud (paper, Alg. 3).
struct SpherizeConfig {
  float radius_m = 40.0f;  ///< m, r_o of the paper: points further from the node are left out
  float voxel_m = 0.1f;    ///< m, thinning before anything else
  bool remove_ground = true;
  /// m, the ground is kept, thinned to this, because it alone holds height and tilt where all else is
  /// upright; 0 keeps none of it, as in the paper.
  float ground_voxel_m = 2.0f;
  cloud::GroundConfig ground;  ///< its `up` is that of the call
  cloud::OutlierConfig outliers;
  cloud::FitConfig fit;  ///< byte budget; its min_voxel_m is raised to voxel_m
  Status validate() const;
};

}  // namespace fleetmap::registration
