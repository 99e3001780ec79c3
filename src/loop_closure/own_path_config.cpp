#include "fleetmap/loop_closure/own_path_config.hpp"

#include <cmath>

namespace fleetmap::loop_closure {

Status OwnPathConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(reach)) return failure("own_path.reach must be > 0 m");
  if (!(std::isfinite(min_path) && min_path >= 2.0 * reach)) {
    return failure("own_path.min_path must be at least twice the reach");
  }
  if (!(std::isfinite(spacing) && spacing >= 0.0)) return failure("own_path.spacing must be >= 0 m");
  return {};
}

}  // namespace fleetmap::loop_closure
