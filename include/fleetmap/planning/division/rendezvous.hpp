#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division/division.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

struct RendezvousConfig {
  double c_max = 90.0;                  ///< m, reach of the short-range link (C_max of the paper)
  double bandwidth = 15e6;              ///< bit/s of the short-range link: one channel for the whole fleet
  double efficiency = 0.7;              ///< share of `bandwidth` that carries maps
  double map_bytes_per_metre = 6000.0;  ///< of submaps that a robot makes per metre driven
  double spacing = 4.0;                 ///< m between robots that wait
  double sample_period = 2.0;           ///< s, step of the forecast of who passes whom and what flows then
  double settle_time = 10.0;            ///< s that a stop takes besides the transfer: find, stop, agree
  double least_gain = 30.0;  ///< s by which a stop must make the fleet complete earlier to be worth it
  Status validate() const;
};

/// Where all robots meet after their last rows.
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
