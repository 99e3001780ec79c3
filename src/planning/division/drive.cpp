#include "division/drive.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::planning {

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

}  // namespace fleetmap::planning
