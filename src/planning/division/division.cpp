#include "fleetmap/planning/division/division.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "division/division_search.hpp"

namespace fleetmap::planning {
namespace {

/// Takes rows from routes that no battery allows, those first that save most.
std::vector<std::size_t> leave_out(std::vector<TimedRoute>& routes) {
  std::vector<std::size_t> left;
  for (TimedRoute& route : routes) {
    while (route.overtime() > 0.0 && !route.rows().empty()) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < route.rows().size(); ++k) {
        if (route.time_without(k) < route.time_without(best)) best = k;
      }
      std::vector<std::size_t> rest = route.rows();
      left.push_back(rest[best]);
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
      route.assign(std::move(rest));
    }
  }
  std::ranges::sort(left);
  return left;
}

RobotRoute result_of(const Mission& mission, const TimedRoute& route, const Worker& worker) {
  RobotRoute result{worker.ability.id, {}, route.time(), 0.0, 0.0};
  const std::vector<bool> reversed = route.directions();
  for (std::size_t k = 0; k < route.rows().size(); ++k) {
    result.visits.push_back({mission.rows[route.rows()[k]].id, reversed[k]});
  }
  const Travel travel = route.travel();
  result.length = travel.length;
  result.energy_wh = energy_of(travel, worker.ability);
  return result;
}

Status check_fleet(const Mission& mission, std::span<const RobotAbility> fleet) {
  if (fleet.empty()) return failure("division: no robots");
  std::set<AgentId> names;
  for (const RobotAbility& robot : fleet) {
    if (const Status status = robot.validate(); !status) return status;
    if (!names.insert(robot.id).second) return failure("division: two robots are named " + robot.id.str());
  }
  if (fleet.size() > mission.rows.size()) {
    return failure("division: " + std::to_string(fleet.size()) + " robots for " +
                   std::to_string(mission.rows.size()) +
                   " rows; take fewer robots, more lanes (every: 1), or cut long rows (max_row_length)");
  }
  return {};
}

}  // namespace

Division divide_rows(const Mission& mission, const TravelCosts& costs, std::span<const std::size_t> rows,
                     std::span<const Worker> workers, std::span<const Travel> to_end,
                     const DivisionConfig& config) {
  Division division;
  if (workers.empty()) return division;
  std::vector<TimedRoute> routes = config.method == DivisionMethod::kUniform
                                       ? uniform_division(costs, rows, workers, to_end)
                                       : search_division(costs, rows, workers, to_end, config);
  if (config.method == DivisionMethod::kEnergy) {
    for (const std::size_t row : leave_out(routes)) division.left_out.push_back(mission.rows[row].id);
  }
  for (std::size_t k = 0; k < workers.size(); ++k) {
    division.routes.push_back(result_of(mission, routes[k], workers[k]));
    division.makespan = std::max(division.makespan, routes[k].time());
  }
  return division;
}

Result<Division> divide(const Mission& mission, const TravelCosts& costs, std::span<const RobotAbility> fleet,
                        const std::optional<Eigen::Vector2d>& meeting, const DivisionConfig& config) {
  if (const Status status = config.validate(); !status) return tl::unexpected(status.error());
  if (const Status status = check_fleet(mission, fleet); !status) return tl::unexpected(status.error());
  std::vector<Worker> workers;
  for (const RobotAbility& robot : fleet) {
    Worker worker{robot, costs.from(robot.start)};
    if (config.method == DivisionMethod::kEnergy) {
      worker.energy_wh = robot.battery_wh * (1.0 - config.battery_reserve);
    }
    const bool reaches =
        std::ranges::any_of(worker.from, [](const Travel& t) { return std::isfinite(t.length); });
    if (!reaches) {
      return failure("robot " + robot.id.str() + " at (" + std::to_string(robot.start.position.x()) + ", " +
                     std::to_string(robot.start.position.y()) +
                     ") m can't reach any row; move its start to clear ground that is joined to the rows");
    }
    workers.push_back(std::move(worker));
  }
  std::vector<std::size_t> rows(mission.rows.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  const std::vector<Travel> to_end = meeting ? costs.to(*meeting) : std::vector<Travel>();
  return divide_rows(mission, costs, rows, workers, to_end, config);
}

}  // namespace fleetmap::planning
