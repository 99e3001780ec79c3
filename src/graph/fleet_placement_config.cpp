#include "fleetmap/graph/fleet_placement_config.hpp"

namespace fleetmap::graph {

Status FleetPlacementConfig::validate() const {
  if (!(gps_correlation_time > 0.0)) return failure("fleet.gps_correlation_time must be positive");
  if (!(gps_drift_share > 0.0 && gps_drift_share < 1.0)) {
    return failure("fleet.gps_drift_share must lie between 0 and 1");
  }
  if (!(window_m > 0.0)) return failure("fleet.window_m must be positive");
  if (!(alignment_floor_m > 0.0) || !(alignment_floor_rad > 0.0)) {
    return failure("fleet.alignment_floor_m and alignment_floor_rad must be positive");
  }
  return {};
}

}  // namespace fleetmap::graph
