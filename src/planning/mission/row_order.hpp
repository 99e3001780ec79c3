#pragma once

#include <cstddef>
#include <span>

#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::planning {

/// The row that robot `self` at `pose` drives first on the shortest way through all of `rows` (at least one)
/// to the meeting, and its direction.
RowVisit first_visit(const FleetPlan& plan, std::size_t self, const Pose2& pose,
                     std::span<const std::size_t> rows);

}  // namespace fleetmap::planning
