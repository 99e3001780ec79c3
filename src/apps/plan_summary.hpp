#pragma once

#include <ostream>

#include "drawn_site.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::apps {

/// What each robot drives, and when all is done.
void print_plan(std::ostream& out, const planning::FleetPlan& plan, const DrawnSite& site);

}  // namespace fleetmap::apps
