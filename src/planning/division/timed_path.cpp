#include "fleetmap/planning/division/timed_path.hpp"

#include <algorithm>

#include "division/drive.hpp"

namespace fleetmap::planning {

Eigen::Vector2d TimedPath::at(double time) const {
  const auto after = std::ranges::upper_bound(times, time);
  if (after == times.begin()) return points.front();
  if (after == times.end()) return points.back();
  const auto k = static_cast<std::size_t>(after - times.begin());
  const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
  return points[k - 1] + share * (points[k] - points[k - 1]);
}

double TimedPath::driven(double time) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < points.size() && times[k - 1] < time; ++k) {
    const double step = (points[k] - points[k - 1]).norm();
    const double span = times[k] - times[k - 1];
    sum += span > 0.0 ? step * std::min(1.0, (time - times[k - 1]) / span) : step;
  }
  return sum;
}

TimedPath timed_path(const RoutePlanner& planner, const Mission& mission, const RobotAbility& robot,
                     std::span<const RowVisit> visits, const std::optional<Eigen::Vector2d>& end) {
  Drive drive(robot, robot.start);
  for (const RowVisit& visit : visits) drive.add_row(planner, mission, visit);
  if (end) drive.add_way(planner, *end);
  return drive.path();
}

}  // namespace fleetmap::planning
