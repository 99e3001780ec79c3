#include "fleetmap/place/node_generator_config.hpp"

#include <cmath>

namespace fleetmap::place {

Status NodeGeneratorConfig::validate() const {
  if (!(spacing > 0.0) || !std::isfinite(spacing))
    return failure("spacing: must be a finite number of metres > 0");
  return {};
}

}  // namespace fleetmap::place
