#include "fleetmap/registration/spherize_config.hpp"

#include <cmath>

namespace fleetmap::registration {

Status SpherizeConfig::validate() const {
  if (!(radius_m > 0.0f) || !std::isfinite(radius_m)) return failure("spherize radius_m must be positive");
  if (!(voxel_m > 0.0f) || !std::isfinite(voxel_m)) return failure("spherize voxel_m must be positive");
  if (!(ground_voxel_m >= 0.0f)) return failure("spherize ground_voxel_m must not be negative");
  for (const Status& part : {ground.validate(), outliers.validate(), fit.validate()}) {
    if (!part) return failure("spherize: " + part.error().message);
  }
  return {};
}

}  // namespace fleetmap::registration
