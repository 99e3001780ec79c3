#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division/division_config.hpp"
#include "fleetmap/planning/routes/travel_costs.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// A row and the direction in which it is driven.
struct RowVisit {
  RowId row = 0;
  bool reversed = false;  ///< driven from its last waypoint to its first
  bool operator==(const RowVisit&) const = default;
};

/// The rows that one robot drives.
struct RobotRoute {
  AgentId agent;
  std::vector<RowVisit> visits;  ///< in order
  double time = 0.0;             ///< s, from the start to the end of the route (the meeting place, if any)
  double length = 0.0;           ///< m
  double energy_wh = 0.0;
};

/// Rows of a mission, divided among the robots.
struct Division {
  std::vector<RobotRoute> routes;  ///< one a robot, in the order of the fleet
  double makespan = 0.0;           ///< s, of the longest route
  std::vector<RowId> left_out;     ///< kEnergy: no battery reaches them any more
};

/// A robot as far as a division of rows is concerned.
struct Worker {
  RobotAbility ability;
  std::vector<Travel> from;  ///< to entering at each end (TravelCosts::from)
  double busy = 0.0;         ///< s until it can set out
  double energy_wh = 1e12;   ///< that it may use, from when it sets out
};

/// Divides rows (indices in the mission's order) among the workers so that the last one is done as early as
/// possible; `to_end` (TravelCosts::to) is the way from the last row to where all end, if any. Contiguous
/// groups by bisection of the time, then local search (moves, swaps, exchanged tails, reversals) from a fixed
/// seed: the same input gives the same answer on every robot.
Division divide_rows(const Mission& mission, const TravelCosts& costs, std::span<const std::size_t> rows,
                     std::span<const Worker> workers, std::span<const Travel> to_end,
                     const DivisionConfig& config);

/// The whole mission among the whole fleet, from their starts. Fails, with the remedy, if there are more
/// robots than rows, names are double, or a robot can't reach the rows.
Result<Division> divide(const Mission& mission, const TravelCosts& costs, std::span<const RobotAbility> fleet,
                        const std::optional<Eigen::Vector2d>& meeting, const DivisionConfig& config);

}  // namespace fleetmap::planning
