#include "fleetmap/planning/division/rendezvous_config.hpp"

#include <cmath>

namespace fleetmap::planning {

Status RendezvousConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(c_max)) return failure("c_max: must be > 0 m");
  if (!positive(bandwidth)) return failure("bandwidth: must be > 0 bit/s");
  if (!(efficiency > 0.0 && efficiency <= 1.0)) return failure("efficiency: must be within (0, 1]");
  if (!(std::isfinite(map_bytes_per_metre) && map_bytes_per_metre >= 0.0)) {
    return failure("map_bytes_per_metre: must be >= 0");
  }
  if (!(positive(spacing) && spacing < c_max)) return failure("spacing: must be > 0 m and below c_max");
  if (!positive(sample_period)) return failure("sample_period: must be > 0 s");
  if (!(std::isfinite(stop_overhead) && stop_overhead >= 0.0))
    return failure("stop_overhead: must be >= 0 s");
  if (!(std::isfinite(min_gain) && min_gain >= 0.0)) return failure("min_gain: must be >= 0 s");
  return {};
}

}  // namespace fleetmap::planning
