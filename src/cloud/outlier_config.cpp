#include "fleetmap/cloud/outlier_config.hpp"

namespace fleetmap::cloud {

Status OutlierConfig::validate() const {
  if (neighbors < 1 || neighbors > kMaxNeighbors) return failure("neighbors must be in [1, 63]");
  if (!(sigmas >= 0.0)) return failure("sigmas must not be negative");
  return {};
}

}  // namespace fleetmap::cloud
