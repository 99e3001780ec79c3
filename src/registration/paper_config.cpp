#include "fleetmap/registration/paper_config.hpp"

namespace fleetmap::registration {

Status PaperConfig::validate() const {
  if (!(voxel_m >= 0.05f && voxel_m <= 2.0f))
    return failure("registration paper.voxel must lie in [0.05, 2] m");
  if (!(feature_voxel_m >= voxel_m && feature_voxel_m <= 5.0f))
    return failure("registration paper.feature_voxel must lie between paper.voxel and 5 m");
  if (normal_neighbours < 3) return failure("registration paper.normal_neighbours must be at least 3");
  if (!(feature_radius_m > feature_voxel_m && feature_radius_m <= 20.0f))
    return failure("registration paper.feature_radius must lie between paper.feature_voxel and 20 m");
  if (ransac_iterations < 1 || icp_iterations < 1)
    return failure("registration paper.ransac_iterations and icp_iterations must be at least 1");
  if (!(min_side_ratio >= 0.0 && min_side_ratio < 1.0))
    return failure("registration paper.min_side_ratio must lie in [0, 1)");
  if (!(ransac_inlier_m > 0.0 && inlier_m > 0.0))
    return failure("registration paper.ransac_inlier and inlier_distance must be positive");
  if (!(max_rmse_m > 0.0)) return failure("registration paper.max_rmse must be positive");
  if (!(min_inlier_fraction >= 0.0 && min_inlier_fraction <= 1.0))
    return failure("registration paper.min_inlier_fraction must lie in [0, 1]");
  return {};
}

}  // namespace fleetmap::registration
