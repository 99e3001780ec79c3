#pragma once

#include "fleetmap/cloud/fit_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// A cloud thinned until its encoding fits a byte budget.
struct FittedCloud {
  Bytes bytes;
  PointCloud decoded;       ///< as every receiver of `bytes` decodes it
  float voxel_m = 0.0f;     ///< m, of the thinning
  double resolution_m = 0;  ///< m, of the coding
  int encodings = 0;        ///< number of trials
};

/// The finest voxel grid (centroids) whose encoding fits `max_bytes`, found to within a few per cent of the
/// budget. Points that are not finite are left out. Fails where even `max_voxel_m` does not fit.
Result<FittedCloud> encode_within(const PointCloud& cloud, const FitConfig& config);

}  // namespace fleetmap::cloud
