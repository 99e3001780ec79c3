#include "fleetmap/cloud/fit_config.hpp"

#include <cmath>

namespace fleetmap::cloud {

Status FitConfig::validate() const {
  if (max_bytes < 64) return failure("max_bytes must be at least 64");
  if (!std::isfinite(min_voxel_m) || min_voxel_m < 1e-4f)
    return failure("min_voxel_m must be at least 0.0001 m");
  if (!std::isfinite(max_voxel_m) || max_voxel_m < min_voxel_m) {
    return failure("max_voxel_m must be at least min_voxel_m");
  }
  if (!(voxel_over_resolution >= 1.0 && voxel_over_resolution <= 100.0)) {
    return failure("voxel_over_resolution must be in [1, 100]");
  }
  if (max_encodings < 3) return failure("max_encodings must be at least 3");
  return {};
}

}  // namespace fleetmap::cloud
