#include "fleetmap/registration/registration_config.hpp"

namespace fleetmap::registration {

const char* to_string(Method method) {
  switch (method) {
    case Method::correlation:
      return "correlation";
    case Method::paper:
      return "paper";
  }
  return "?";
}

Status RegistrationConfig::validate() const {
  if (!(max_range_m >= 5.0f && max_range_m <= 200.0f))
    return failure("registration max_range_m must lie in [5, 200] m");
  if (!(voxel_m > 0.0f)) return failure("registration voxel_m must be positive");
  if (!(surfel_m >= 0.1f && surfel_m <= 2.0f)) return failure("registration surfel_m must lie in [0.1, 2] m");
  if (!(cell_m >= 0.2f && cell_m <= 5.0f)) return failure("registration cell_m must lie in [0.2, 5] m");
  if (!(yaw_step_rad >= 0.002f && yaw_step_rad <= 0.5f))
    return failure("registration yaw_step_rad must lie in [0.002, 0.5] rad");
  if (!(prior_sigmas > 0.0)) return failure("registration prior_sigmas must be positive");
  if (!(max_search_m >= 1.0f && max_search_m <= 200.0f))
    return failure("registration max_search_m must lie in [1, 200] m");
  if (!(min_overlap > 0.0 && min_overlap <= 1.0))
    return failure("registration min_overlap must lie in (0, 1]");
  if (max_candidates < 1) return failure("registration max_candidates must be at least 1");
  if (max_modes < 1) return failure("registration max_modes must be at least 1");
  if (coarse_points < 10) return failure("registration coarse_points must be at least 10");
  if (fine_points < 10) return failure("registration fine_points must be at least 10");
  if (!(inlier_m > 0.0f)) return failure("registration inlier_m must be positive");
  if (!(misfit_m > 0.0f)) return failure("registration misfit_m must be positive");
  if (!(patch_m >= 1.0f && patch_m <= 50.0f)) return failure("registration patch_m must lie in [1, 50] m");
  if (!(max_excess > 0.0)) return failure("registration max_excess must be positive");
  if (!(min_weight > 0.5 && min_weight < 1.0)) return failure("registration min_weight must lie in (0.5, 1)");
  if (const Status paper_valid = paper.validate(); !paper_valid) return paper_valid;
  if (const Status icp_valid = icp.validate(); !icp_valid)
    return failure("registration: " + icp_valid.error().message);
  return {};
}

}  // namespace fleetmap::registration
