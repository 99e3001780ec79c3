#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// Voxels of a merged map.
struct MergeConfig {
  double voxel_m = 0.1;    ///< m, edge of the grid in the site's frame; one point is kept in each voxel
  bool centroids = false;  ///< the mean of a voxel's points rather than the first of them
  Status validate() const;
};

}  // namespace fleetmap::store
