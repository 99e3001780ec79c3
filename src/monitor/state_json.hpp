#pragma once

#include <string>

#include "fleetmap/monitor/fleet_view.hpp"

namespace fleetmap::monitor {

/// The page's model of a fleet: all but the points (docs/reference/commands.md). Angles are degrees, times
/// are seconds since the first node.
std::string state_json(const FleetView& view);

}  // namespace fleetmap::monitor
