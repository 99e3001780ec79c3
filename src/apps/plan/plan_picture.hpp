#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/image.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::apps {

/// A plan from above, north up: keep-outs and boundary, each robot's rows and ways in its colour, the meeting
/// place.
Result<eval::Image> picture_of(const planning::FleetPlan& plan);

}  // namespace fleetmap::apps
