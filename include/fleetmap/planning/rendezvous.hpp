#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division.hpp"
#include "fleetmap/planning/mission.hpp"
#include "fleetmap/planning/route_planner.hpp"

namespace fleetmap::planning {

struct RendezvousConfig {
  double c_max = 90.0;                  ///< m, reach of the short-range link (C_max of the paper)
  double bandwidth = 15e6;              ///< bit/s of the short-range link, shared by those who meet
  double efficiency = 0.7;              ///< share of `bandwidth` that carries maps
  double map_bytes_per_metre = 6000.0;  ///< of submaps that a robot makes per metre driven
  double spacing = 4.0;                 ///< m between robots that wait
  double sample_period = 2.0;           ///< s, at which routes are looked at for robots that pass each other
  double settle_time = 10.0;            ///< s that a meeting takes besides the transfer: find, stop, agree
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

/// A robot's position over time: it waits at the end.
struct TimedPath {
  Polyline points;            ///< ENU, m
  std::vector<double> times;  ///< s, one a point, not falling
  Eigen::Vector2d at(double time) const;
  double driven(double time) const;  ///< m
};

/// What flows between two robots that come within C_max on their way.
struct Contact {
  std::size_t a = 0, b = 0;  ///< indices of paths, a < b
  double time = 0.0;         ///< s, when they are nearest to each other before the meeting
  double distance = 0.0;     ///< m, then
  double seconds = 0.0;      ///< within C_max before the meeting
  double bytes = 0.0;        ///< that can flow in this time, of what exists by then
};
std::vector<Contact> contacts(std::span<const TimedPath> paths, double until, const RendezvousConfig& config);

/// A stop for two robots to exchange maps before the common meeting.
struct Detour {
  std::size_t a = 0, b = 0;  ///< indices of paths
  double time = 0.0;         ///< s
  double cost = 0.0;         ///< s that the fleet is done later by it, without what it saves
  double saving = 0.0;       ///< s less of transfer at the common meeting
};

/// What is to be exchanged where, and what a stop in between would be worth.
struct ExchangePlan {
  double bytes_total = 0.0;          ///< all maps to all robots
  double bytes_in_passing = 0.0;     ///< flow where routes pass each other anyway
  double transfer_at_meeting = 0.0;  ///< s, for the rest
  std::vector<Contact> passing;
  std::vector<Detour> worth;  ///< stops whose saving is larger than their cost
  int rejected = 0;           ///< stops looked at that are not worth it
};
/// A stop costs both robots the way to within C_max of each other and the transfer; it delays the fleet by
/// what goes beyond the time for which they would wait at the meeting anyway. `arrivals`: s, at the meeting.
ExchangePlan plan_exchange(std::span<const TimedPath> paths, std::span<const double> arrivals,
                           std::span<const double> speeds, const RendezvousConfig& config);

}  // namespace fleetmap::planning
