#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division/division.hpp"
#include "fleetmap/planning/division/exchange_plan.hpp"
#include "fleetmap/planning/division/rendezvous.hpp"
#include "fleetmap/planning/division/timed_path.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/planning/routes/travel_costs.hpp"

namespace fleetmap::planning {

/// Everything the fleet agrees on before it sets out: each robot computes the same from the same input.
/// Immutable, so that robots of one process may share it.
struct FleetPlan {
  Mission mission;
  std::vector<RobotAbility> fleet;  ///< in the order of names
  MissionConfig config;
  RoutePlanner planner;
  TravelCosts costs;
  Division division;  ///< routes in the order of `fleet`, the way to the meeting and stops included
  std::optional<MeetingPlace> meeting;
  std::optional<ExchangePlan> exchange;  ///< with a meeting; stops before it with division energy only
  double completion = 0.0;  ///< s, all rows driven and, with a meeting, all met and all maps exchanged

  /// Index of a robot in `fleet`.
  std::optional<std::size_t> find(const AgentId& id) const;
};

/// The way of the robot `index` of the plan's fleet: from its start through its rows to the meeting. ENU, m.
Polyline route_of(const FleetPlan& plan, std::size_t index);

/// Fails, with the remedy, for whatever is wrong with mission, fleet or settings.
Result<std::shared_ptr<const FleetPlan>> plan_fleet(Mission mission, std::span<const RobotAbility> fleet,
                                                    const MissionConfig& config);

}  // namespace fleetmap::planning
