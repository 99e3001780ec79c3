#include "fleetmap/cloud/normal_config.hpp"

namespace fleetmap::cloud {

Status NormalConfig::validate() const {
  if (neighbors < 3 || neighbors > kMaxNeighbors) return failure("neighbors must be in [3, 64]");
  if (min_neighbors < 3 || min_neighbors > neighbors)
    return failure("min_neighbors must be in [3, neighbors]");
  if (!(max_radius_m > 0.0f)) return failure("max_radius_m must be positive");
  return {};
}

}  // namespace fleetmap::cloud
