#pragma once

#include <string>
#include <vector>

#include "fleetmap/monitor/fleet_view.hpp"

namespace fleetmap::monitor {

/// A clause on each session of a robot that neither another robot nor the robot's main sessions are joined
/// with, such as "r2's second session is not joined": nothing ties its place in the map to theirs. A robot's
/// main sessions are those of its component with the most robots, then nodes.
std::vector<std::string> loose_sessions(const FleetView& view);

}  // namespace fleetmap::monitor
