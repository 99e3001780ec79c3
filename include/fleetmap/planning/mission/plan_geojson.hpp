#pragma once

#include <span>
#include <string>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"

namespace fleetmap::planning {

/// The division as a map shows it: each row with its robot ("robot") and each robot's way ("route",
/// "length_m", "time_s") in its colour ("#rrggbb", property "stroke" of simplestyle), the meeting place, and
/// the site.
std::string to_geojson(const FleetPlan& plan, std::span<const std::string> colours, const LocalFrame& site,
                       FileFrame frame = FileFrame::kWgs84);

}  // namespace fleetmap::planning
