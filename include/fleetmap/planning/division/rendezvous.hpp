#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division/division.hpp"
#include "fleetmap/planning/division/rendezvous_config.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Meeting place of all robots after their last rows.
struct MeetingPlace {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< ENU, m
  Polyline positions;                               ///< where each robot waits, in the order of the fleet
  std::vector<double> arrivals;                     ///< s, of each robot
  double latest = 0.0;                              ///< s
};

/// A robot that becomes free at `position` after `time`.
struct Arrival {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< ENU, m
  double time = 0.0;                                   ///< s
  double speed = 1.5;                                  ///< m/s
};

/// The place at which the last robot arrives as early as possible, and a place for each near it: within C_max
/// of each other, `spacing` apart where there is room. Fails if the robots can't get to any common place.
Result<MeetingPlace> meeting_place(const RoutePlanner& planner, std::span<const Arrival> arrivals,
                                   const RendezvousConfig& config);

}  // namespace fleetmap::planning
