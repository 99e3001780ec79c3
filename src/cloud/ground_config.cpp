#include "fleetmap/cloud/ground_config.hpp"

namespace fleetmap::cloud {

Status GroundConfig::validate() const {
  if (!up.allFinite() || !(up.norm() > 1e-6f)) return failure("up must be a finite vector other than zero");
  if (!(cell_m >= 0.05f && cell_m <= 100.0f)) return failure("cell_m must be in [0.05, 100] m");
  if (!(thickness_m > 0.0f)) return failure("thickness_m must be positive");
  if (!(step_m > 0.0f)) return failure("step_m must be positive");
  if (!(max_slope_rad > 0.0f && max_slope_rad < 1.5f))
    return failure("max_slope_rad must be in (0, 1.5) rad");
  if (!(max_slope_change_rad >= 0.0f && max_slope_change_rad < 1.5f))
    return failure("max_slope_change_rad must be in [0, 1.5) rad");
  if (!(min_area_m2 >= 0.0f)) return failure("min_area_m2 must not be negative");
  return {};
}

}  // namespace fleetmap::cloud
