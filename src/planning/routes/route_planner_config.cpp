#include "fleetmap/planning/routes/route_planner_config.hpp"

namespace fleetmap::planning {

Status RoutePlannerConfig::validate() const {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(clearance, 0.0, 20.0)) return failure("clearance: must be within [0, 20] m");
  if (!within(cell, 0.05, 5.0)) return failure("cell: must be within [0.05, 5] m");
  if (!within(snap, 0.0, 100.0)) return failure("snap: must be within [0, 100] m");
  if (!within(margin, 0.0, 1000.0)) return failure("margin: must be within [0, 1000] m");
  return {};
}

}  // namespace fleetmap::planning
