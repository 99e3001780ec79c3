#pragma once

#include <filesystem>

#include "drawn_site.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::apps {

/// Writes a plan as GeoJSON to `out`, and a picture of it beside. Returns the path of the picture (.png).
Result<std::filesystem::path> write_plan(const planning::FleetPlan& plan, const DrawnSite& site,
                                         const std::filesystem::path& out);

}  // namespace fleetmap::apps
