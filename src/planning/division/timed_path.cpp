#include "fleetmap/planning/division/timed_path.hpp"

#include <algorithm>
#include <cmath>

#include "division/drive.hpp"
#include "fleetmap/geometry/se3.hpp"

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

void Drive::add(const Polyline& line) {
  for (const Eigen::Vector2d& p : line) {
    const Eigen::Vector2d d = p - path_.points.back();
    if (d.norm() < 1e-3) continue;
    const double heading = std::atan2(d.y(), d.x());
    const double turn = std::abs(wrap_angle(heading - yaw_));
    yaw_ = heading;
    path_.times.push_back(path_.times.back() + turn / robot_->yaw_rate);
    path_.points.push_back(path_.points.back());
    path_.times.push_back(path_.times.back() + d.norm() / robot_->speed);
    path_.points.push_back(p);
  }
}

void Drive::add_way(const RoutePlanner& planner, const Eigen::Vector2d& to) {
  if (const auto way = planner.route(path_.points.back(), to)) add(*way);
}

void Drive::add_row(const RoutePlanner& planner, const Mission& mission, const RowVisit& visit) {
  const auto row = planner.along(*std::ranges::find(mission.rows, visit.row, &Row::id), visit.reversed);
  if (!row) return;
  add_way(planner, row->front());
  add(*row);
}

TimedPath timed_path(const RoutePlanner& planner, const Mission& mission, const RobotAbility& robot,
                     std::span<const RowVisit> visits, const std::optional<Eigen::Vector2d>& end) {
  Drive drive(robot, robot.start);
  for (const RowVisit& visit : visits) drive.add_row(planner, mission, visit);
  if (end) drive.add_way(planner, *end);
  return drive.path();
}

}  // namespace fleetmap::planning
