#include "fleetmap/planning/routes/travel_costs.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "fleetmap/geometry/se3.hpp"
#include "routes/heading.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kNoLength = 0.05;  // m: pieces of one lane meet, there is no way between them

double angle(double a, double b) { return std::abs(wrap_angle(a - b)); }

/// Turns at both ends of a leg that leaves in direction `out` and arrives for direction `in`.
Travel joined(const RoutePlanner::Leg& leg, double out, double in) {
  if (!std::isfinite(leg.length)) return {};
  const double turn = leg.length < kNoLength
                          ? angle(out, in)
                          : angle(out, leg.first_heading) + leg.turn + angle(leg.last_heading, in);
  return {static_cast<float>(leg.length), static_cast<float>(turn)};
}

}  // namespace

double time_of(const Travel& travel, const RobotAbility& robot) {
  return travel.length / robot.speed + travel.turn / robot.yaw_rate;
}

double energy_of(const Travel& travel, const RobotAbility& robot) {
  return time_of(travel, robot) * robot.power_idle_w / 3600.0 + travel.length * robot.energy_per_metre_wh;
}

Result<TravelCosts> TravelCosts::create(const RoutePlanner& planner, const Mission& mission) {
  TravelCosts costs(planner);
  for (const Row& row : mission.rows) {
    const auto line = planner.along(row, false);
    if (!line) return tl::unexpected(line.error());
    const Polyline& p = *line;
    Travel along{static_cast<float>(length_of(p)), 0.0f};
    for (std::size_t k = 2; k < p.size(); ++k) {
      along.turn += static_cast<float>(angle(heading(p[k] - p[k - 1]), heading(p[k - 1] - p[k - 2])));
    }
    costs.along_.push_back(along);
    costs.inward_.push_back(heading(p[1] - p[0]));
    costs.inward_.push_back(heading(p[p.size() - 2] - p.back()));
    for (const Eigen::Vector2d& end : {p.front(), p.back()}) costs.ends_.push_back(planner.anchor(end));
  }
  const std::size_t ends = costs.ends_.size();
  costs.between_.resize(ends * ends);
  for (std::size_t a = 0; a < ends; ++a) {
    const double out = costs.inward_[a] + std::numbers::pi;
    const std::vector<RoutePlanner::Leg> legs =
        planner.legs(costs.ends_[a], std::span(costs.ends_).subspan(a));
    for (std::size_t b = a; b < ends; ++b) {
      // The same way back turns as much: what leaves a for b also leaves b for a.
      const Travel travel = joined(legs[b - a], out, costs.inward_[b]);
      if (!std::isfinite(travel.length)) {
        const auto why = planner.route(costs.ends_[a].point, costs.ends_[b].point);
        const std::string row = "row " + std::to_string(mission.rows[b / 2].id);
        const std::string other = " can't be reached from row " + std::to_string(mission.rows[a / 2].id);
        return failure(row + (a / 2 == b / 2 ? " can't be driven" : other) + ": " +
                       (why ? "no way" : why.error().message));
      }
      costs.between_[a * ends + b] = travel;
      costs.between_[b * ends + a] = travel;
    }
  }
  return costs;
}

std::vector<Travel> TravelCosts::from(const Pose2& pose) const {
  const RoutePlanner::Anchor start = planner_.anchor(pose.position);
  const std::vector<RoutePlanner::Leg> legs = planner_.legs(start, ends_);
  std::vector<Travel> travels(ends_.size());
  for (std::size_t k = 0; k < ends_.size(); ++k) travels[k] = joined(legs[k], pose.yaw, inward_[k]);
  return travels;
}

std::vector<Travel> TravelCosts::to(const Eigen::Vector2d& place) const {
  const std::vector<RoutePlanner::Leg> legs = planner_.legs(planner_.anchor(place), ends_);
  std::vector<Travel> travels(ends_.size());
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    const double out = inward_[k] + std::numbers::pi;
    const double arriving = legs[k].first_heading + std::numbers::pi;  // the leg was searched backwards
    RoutePlanner::Leg back = legs[k];
    back.first_heading = legs[k].last_heading + std::numbers::pi;
    back.last_heading = arriving;
    travels[k] = joined(back, out, arriving);
  }
  return travels;
}

}  // namespace fleetmap::planning
