#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::registration {

/// The paper's registration (Alg. 3): 33-D FPFH features, RANSAC over their correspondences, point-to-plane
/// ICP. It uses no prior.
struct PaperConfig {
  float voxel_m = 0.3f;           ///< m, both clouds are thinned to it for ICP and for E_ij
  float feature_voxel_m = 0.6f;   ///< m, and to this for the features
  int normal_neighbours = 16;     ///< of a point's normal
  float feature_radius_m = 3.0f;  ///< m, neighbourhood of a feature
  /// Three correspondences are scored if the sides of their triangles in both clouds have at least this
  /// ratio.
  double min_side_ratio = 0.9;
  int ransac_iterations = 10'000;     ///< poses scored at most
  double ransac_inlier_m = 1.0;       ///< m, farthest pair of points that supports a sampled pose
  int icp_iterations = 50;            ///< at most
  double inlier_m = 1.0;              ///< m, farthest pair of points that ICP uses and Eq. 2 counts
  double max_rmse_m = 0.4;            ///< m, E_ij of a good alignment (paper)
  double min_inlier_fraction = 0.25;  ///< inliers over source points; the paper names no such bound
  std::size_t min_points = 100;       ///< of each cloud after thinning to voxel_m
  Status validate() const;
};

}  // namespace fleetmap::registration
