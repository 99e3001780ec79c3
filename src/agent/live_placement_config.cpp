#include "fleetmap/agent/live_placement_config.hpp"

namespace fleetmap::agent {

Status LivePlacementConfig::validate() const {
  if (period <= Duration::zero()) return failure("placement: the period of live solutions must be positive");
  if (!(cpu_share > 0.0 && cpu_share <= 1.0)) return failure("placement.live_cpu_share must lie in (0, 1]");
  if (cost_per_node < Duration::zero()) return failure("placement: the cost of a node must not be negative");
  return {};
}

}  // namespace fleetmap::agent
