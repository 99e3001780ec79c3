#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/planning/division/division.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// A robot's position over time: it waits at the end.
struct TimedPath {
  Polyline points;            ///< ENU, m
  std::vector<double> times;  ///< s, one a point, not falling
  Eigen::Vector2d at(double time) const;
  double driven(double time) const;  ///< m
};

/// Position of a robot over time on its route; `end` is added behind the last row.
TimedPath timed_path(const RoutePlanner& planner, const Mission& mission, const RobotAbility& robot,
                     std::span<const RowVisit> visits, const std::optional<Eigen::Vector2d>& end);

}  // namespace fleetmap::planning
