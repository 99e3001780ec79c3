#pragma once

#include <ostream>

#include "drawn_site.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::apps {

/// Prints the rows of each robot, and when the mission is complete.
void print_plan(std::ostream& out, const planning::FleetPlan& plan, const DrawnSite& site);

}  // namespace fleetmap::apps
