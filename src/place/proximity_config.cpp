#include "fleetmap/place/proximity_config.hpp"

#include <cmath>

namespace fleetmap::place {

const char* to_string(Uncertainty uncertainty) {
  return uncertainty == Uncertainty::variance ? "variance" : "sigma";
}

Status ProximityConfig::validate() const {
  if (!(radius_scale > 0.0) || !std::isfinite(radius_scale)) {
    return failure("radius_scale: must be a finite number > 0");
  }
  if (!(min_radius >= 0.0) || !std::isfinite(min_radius)) {
    return failure("min_radius: must be a finite number of metres >= 0");
  }
  if (!(max_radius >= min_radius) || !std::isfinite(max_radius)) {
    return failure("max_radius: must be a finite number of metres >= min_radius");
  }
  return {};
}

}  // namespace fleetmap::place
