#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"
#include "fleetmap/registration/icp_config.hpp"
#include "fleetmap/registration/paper_config.hpp"

namespace fleetmap::registration {

/// Method by which spherized clouds are registered.
enum class Method {
  correlation,  ///< correlative search over the prior's window, all modes, point-to-surfel ICP
  paper,        ///< FPFH, RANSAC, point-to-plane ICP; no prior
};
const char* to_string(Method method);

/// Everything but `method` and `paper` is of the correlative search.
struct RegistrationConfig {
  Method method = Method::correlation;
  PaperConfig paper;
  float max_range_m = 60.0f;  ///< m, points farther from their cloud's origin are left out
  float voxel_m = 0.1f;       ///< m, both clouds are thinned to it first
  float surfel_m = 0.35f;     ///< m, voxels of the surfels that points are compared with
  // Search.
  float cell_m = 0.6f;               ///< m, of the maps that are correlated
  float yaw_step_rad = 0.022f;       ///< rad
  double prior_sigmas = 4.0;         ///< half width of the search window around the prior
  float max_search_m = 60.0f;        ///< m, at most
  double min_overlap = 0.25;         ///< share of the source that the target must have seen
  std::size_t max_candidates = 200;  ///< of the search, refined coarsely
  std::size_t max_modes = 20;        ///< refined fully
  std::size_t coarse_points = 300;   ///< source points used for candidates
  std::size_t fine_points = 2500;    ///< and for modes
  double distinct_m = 0.8;           ///< m, poses nearer than this and `distinct_rad` are the same mode
  double distinct_rad = 0.08;        ///< rad
  IcpConfig icp;
  // Comparison.
  float inlier_m = 0.25f;  ///< m, a source point this close to a surfel of the target is an inlier
  float misfit_m = 0.1f;   ///< m, distance at which a point's misfit is a half
  float patch_m = 4.0f;    ///< m, points in one square of this edge are one piece of evidence
  // Verdict.
  std::size_t min_points = 100;  ///< of each cloud after thinning
  std::size_t min_inliers = 100;
  double min_inlier_fraction = 0.15;  ///< inliers over source points
  double min_agreement = 0.45;        ///< inliers over source points in the overlap
  double max_rmse_m = 0.2;            ///< m, E_ij of a good alignment (paper)
  double max_excess = 1.05;           ///< rmse over what both clouds' own noise explains
  double min_weight = 0.999;          ///< a mode of less weight is not accepted
  Status validate() const;
};

}  // namespace fleetmap::registration
