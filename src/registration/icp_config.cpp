#include "fleetmap/registration/icp_config.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::registration {

Status IcpConfig::validate() const {
  if (kernels_m.empty()) return failure("icp kernels_m must not be empty");
  for (const float kernel : kernels_m) {
    if (!(kernel > 0.0f)) return failure("icp kernels_m must be positive");
  }
  if (iterations_per_stage < 1) return failure("icp iterations_per_stage must be at least 1");
  if (!(max_stddev_m > 0.0)) return failure("icp max_stddev_m must be positive");
  if (!(min_stddev_m > 0.0)) return failure("icp min_stddev_m must be positive");
  if (!(min_stddev_rad > 0.0)) return failure("icp min_stddev_rad must be positive");
  return {};
}

}  // namespace fleetmap::registration
