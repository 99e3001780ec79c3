#include "fleetmap/planning/site/mission.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "site/point_text.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kMaxReach = 100e3;  // m from the origin: beyond, ENU of one origin is no map any more

bool sound(const Eigen::Vector2d& p) { return p.allFinite() && p.norm() < kMaxReach; }

Status check_polygon(const KeepOut& polygon, const std::string& name) {
  if (polygon.size() < 3) return failure(name + " has fewer than three corners");
  if (std::ranges::all_of(polygon, sound)) return {};
  return failure(name + " has a corner that is not finite or more than 100 km from the site origin");
}

Status check_starts(const std::vector<StartPoint>& starts) {
  std::set<std::optional<AgentId>> agents;
  for (const StartPoint& start : starts) {
    const std::string name = start.agent ? "start of " + start.agent->str() : "common start";
    if (!sound(start.at))
      return failure("mission: the " + name + " is not finite or more than 100 km from the site origin");
    if (!agents.insert(start.agent).second) return failure("mission: there are two points for the " + name);
  }
  return {};
}

}  // namespace

Status Mission::validate() const {
  if (rows.empty()) return failure("mission: no rows to drive; give at least one row of waypoints");
  if (rows.size() > kMaxRows) {
    return failure("mission: " + std::to_string(rows.size()) + " rows, at most " + std::to_string(kMaxRows) +
                   " are allowed; drive every n-th lane (every: n)");
  }
  std::size_t points = 0;
  std::set<RowId> ids;
  for (const Row& row : rows) {
    const std::string name = "mission: row " + std::to_string(row.id);
    if (!ids.insert(row.id).second) return failure(name + " is there twice; ids must be unique");
    if (row.waypoints.size() < 2) return failure(name + " has fewer than two waypoints");
    if (!std::ranges::all_of(row.waypoints, sound)) {
      return failure(name + " has a waypoint that is not finite or more than 100 km from the site origin");
    }
    if (length_of(row.waypoints) <= 0.0) return failure(name + " has no length");
    points += row.waypoints.size();
  }
  for (std::size_t k = 0; k < keep_out.size(); ++k) {
    const Status sound = check_polygon(keep_out[k], "mission: keep-out polygon " + std::to_string(k));
    if (!sound) return sound;
    points += keep_out[k].size();
  }
  if (points > kMaxPoints) return failure("mission: more than a million points; simplify rows and keep-outs");
  if (boundary) {
    if (const Status sound = check_polygon(*boundary, "mission: the boundary"); !sound) return sound;
  }
  return check_starts(starts);
}

Eigen::Vector2d Mission::start_of(const AgentId& agent) const {
  for (const std::optional<AgentId>& wanted : {std::optional<AgentId>(agent), std::optional<AgentId>()}) {
    const auto found = std::ranges::find(starts, wanted, &StartPoint::agent);
    if (found != starts.end()) return found->at;
  }
  return rows.front().waypoints.front();
}

Status RobotAbility::validate() const {
  const std::string name = "robot " + id.str();
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (id.empty()) return failure("robot without a name");
  if (!sound(start.position) || !std::isfinite(start.yaw)) return failure(name + ": start must be finite");
  if (!positive(speed)) return failure(name + ": speed must be > 0 m/s");
  if (!positive(yaw_rate)) return failure(name + ": yaw_rate must be > 0 rad/s");
  if (!positive(battery_wh)) return failure(name + ": battery_wh must be > 0 Wh");
  if (!(std::isfinite(power_idle_w) && power_idle_w >= 0.0)) {
    return failure(name + ": power_idle_w must be >= 0 W");
  }
  if (!(std::isfinite(energy_per_metre_wh) && energy_per_metre_wh >= 0.0)) {
    return failure(name + ": energy_per_metre_wh must be >= 0 Wh/m");
  }
  return {};
}

double length_of(std::span<const Eigen::Vector2d> line) {
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  return length;
}

Status check_within(const Mission& mission, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  for (const Row& row : mission.rows) {
    for (std::size_t k = 0; k < row.waypoints.size(); ++k) {
      const Eigen::Vector2d& p = row.waypoints[k];
      const double outside = (p - p.cwiseMax(low).cwiseMin(high)).norm();
      if (outside == 0.0) continue;
      return failure("row " + std::to_string(row.id) + ", waypoint " + std::to_string(k) + " at " +
                     point_text(p) + " m is " + std::to_string(std::llround(std::ceil(outside))) +
                     " m outside the site, which reaches from " + point_text(low) + " to " +
                     point_text(high) + " m (ENU); correct the waypoint, or the site origin if all are off");
    }
  }
  return {};
}

}  // namespace fleetmap::planning
