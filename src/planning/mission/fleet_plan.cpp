#include "fleetmap/planning/mission/fleet_plan.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning {
namespace {

/// Position and time of a robot after its last row, without the path to a meeting.
Arrival arrival_of(const FleetPlan& plan, std::size_t k) {
  const RobotRoute& route = plan.division.routes[k];
  const RobotAbility& robot = plan.fleet[k];
  if (route.visits.empty()) return {robot.start.position, 0.0, robot.speed};
  const TimedPath path = timed_path(plan.planner, plan.mission, robot, route.visits, std::nullopt);
  return {path.points.back(), path.times.back(), robot.speed};
}

/// Division and meeting place depend on each other: improved in turns, the best pair is kept.
Status divide_and_meet(FleetPlan& plan) {
  std::optional<Eigen::Vector2d> place;
  Division best_division;
  std::optional<MeetingPlace> best_meeting;
  double best = std::numeric_limits<double>::infinity();
  const int turns = plan.config.rendezvous ? 3 : 1;
  for (int turn = 0; turn < turns; ++turn) {
    auto division = divide(plan.mission, plan.costs, plan.fleet, place, plan.config.division);
    if (!division) return tl::unexpected(division.error());
    plan.division = std::move(*division);
    double completion = plan.division.makespan;
    if (plan.config.rendezvous) {
      std::vector<Arrival> arrivals;
      for (std::size_t k = 0; k < plan.fleet.size(); ++k) arrivals.push_back(arrival_of(plan, k));
      auto meeting = meeting_place(plan.planner, arrivals, plan.config.meeting);
      if (!meeting) return tl::unexpected(meeting.error());
      place = meeting->place;
      completion = meeting->latest;
      plan.meeting = std::move(*meeting);
    }
    // The first turn did not know the way to the meeting, for which a battery may not last.
    const bool blind = plan.config.rendezvous && turn == 0;
    if (completion < best && !(blind && plan.config.division.method == DivisionMethod::kEnergy)) {
      best = completion;
      best_division = plan.division;
      best_meeting = plan.meeting;
    }
  }
  plan.division = std::move(best_division);
  plan.meeting = std::move(best_meeting);
  plan.completion = best;
  return {};
}

/// The routes end where the robots meet, and take the time that stops take.
void add_exchange(FleetPlan& plan) {
  const DivisionConfig& division = plan.config.division;
  const ExchangeRules rules{division.method == DivisionMethod::kEnergy, division.battery_reserve};
  plan.exchange = plan_exchange(plan.planner, plan.mission, plan.fleet, plan.division.routes,
                                plan.meeting->positions, plan.config.meeting, rules);
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) {
    const RobotAbility& robot = plan.fleet[k];
    RobotRoute& route = plan.division.routes[k];
    route.time = plan.exchange->arrivals[k];
    route.length = plan.exchange->lengths[k];
    route.energy_wh = route.time * robot.power_idle_w / 3600.0 + route.length * robot.energy_per_metre_wh;
  }
  plan.meeting->arrivals = plan.exchange->arrivals;
  plan.meeting->latest = std::ranges::max(plan.meeting->arrivals);
  plan.division.makespan = plan.meeting->latest;
  plan.completion = plan.exchange->completion;
}

}  // namespace

std::optional<std::size_t> FleetPlan::find(const AgentId& id) const {
  const auto found = std::ranges::find(fleet, id, &RobotAbility::id);
  if (found == fleet.end()) return std::nullopt;
  return static_cast<std::size_t>(found - fleet.begin());
}

Polyline route_of(const FleetPlan& plan, std::size_t index) {
  const std::optional<Eigen::Vector2d> end =
      plan.meeting ? std::optional<Eigen::Vector2d>(plan.meeting->positions[index]) : std::nullopt;
  Polyline route =
      timed_path(plan.planner, plan.mission, plan.fleet[index], plan.division.routes[index].visits, end)
          .points;
  route.erase(std::unique(route.begin(), route.end()), route.end());
  return route;
}

Result<std::shared_ptr<const FleetPlan>> plan_fleet(Mission mission, std::span<const RobotAbility> fleet,
                                                    const MissionConfig& config) {
  if (const Status status = config.validate(); !status) return tl::unexpected(status.error());
  std::vector<Eigen::Vector2d> starts;
  for (const RobotAbility& robot : fleet) {
    if (const Status status = robot.validate(); !status) return tl::unexpected(status.error());
    starts.push_back(robot.start.position);
  }
  auto planner = RoutePlanner::create(mission, config.routes, starts);
  if (!planner) return tl::unexpected(planner.error());
  auto costs = TravelCosts::create(*planner, mission);
  if (!costs) return tl::unexpected(costs.error());
  auto plan = std::make_shared<FleetPlan>(FleetPlan{std::move(mission),
                                                    {fleet.begin(), fleet.end()},
                                                    config,
                                                    std::move(*planner),
                                                    std::move(*costs),
                                                    {},
                                                    {},
                                                    {}});
  // The same on every robot, in whatever order it was told of the others.
  std::ranges::sort(plan->fleet, {}, &RobotAbility::id);
  if (const Status status = divide_and_meet(*plan); !status) return tl::unexpected(status.error());
  if (plan->meeting) add_exchange(*plan);
  return std::shared_ptr<const FleetPlan>(std::move(plan));
}

}  // namespace fleetmap::planning
