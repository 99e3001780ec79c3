#include "fleetmap/sim/fence_config.hpp"

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status FenceConfig::validate() const {
  if (!enabled) return {};
  const Status wire =
      wire_spacing == 0.0 ? Status{} : in_range("wire_spacing", wire_spacing, 0.04, 1.0, " m (or 0)");
  return first_failure({in_range("height", height, 0.5, 5.0, " m"),
                        in_range("post_spacing", post_spacing, 1.0, 10.0, " m"), wire,
                        in_range("wire_width", wire_width, 0.001, 0.05, " m")});
}

}  // namespace fleetmap::sim
