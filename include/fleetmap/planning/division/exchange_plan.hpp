#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "fleetmap/planning/division/division.hpp"
#include "fleetmap/planning/division/rendezvous.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// A stop for two robots to exchange maps before the common meeting.
struct Detour {
  struct Part {
    std::size_t robot = 0;  ///< index in the fleet
    std::size_t after = 0;  ///< rows of its route that it has driven before; then comes the stop
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< ENU, m, where it waits
    double arrival = 0.0;                             ///< s
  };
  std::array<Part, 2> parts;  ///< the lower index first; their places lie within C_max
  double leave = 0.0;         ///< s, when both hold the same and go on
  double saving = 0.0;        ///< s that the fleet completes earlier by it, given the stops before it
};

/// Places and times at which robots stop to exchange maps.
struct ExchangePlan {
  std::vector<double> arrivals;           ///< s, of each robot at the meeting, stops included
  std::vector<double> lengths;            ///< m that each robot drives, ways to stops included
  double completion = 0.0;                ///< s, all have met and hold all maps
  double completion_without_stops = 0.0;  ///< s
  double transfer_at_meeting = 0.0;       ///< s, from the last arrival to the completion
  double bytes_total = 0.0;               ///< all maps to all robots
  double bytes_in_passing = 0.0;          ///< of these, received by robots under way
  double bytes_at_stops = 0.0;            ///< of these, received by robots at stops
  std::vector<Detour> stops;              ///< worth it, in the order in which they were found
  int rejected = 0;                       ///< stops that were tried out and are not worth it
};

/// Rules for stops at which two robots exchange maps.
struct ExchangeRules {
  bool stops = false;            ///< look for stops, not only at the common meeting
  double battery_reserve = 0.2;  ///< share of a battery that no stop may touch
};

/// Forecasts what flows when if the fleet drives its routes and meets at `meeting` (one position a robot):
/// robots within C_max exchange maps, others' maps too, over one channel that all share, under way, at stops,
/// and at the meeting while they wait for the last. Stops are added one after another, each time the one by
/// which the fleet, as forecast with those before it, completes soonest, as long as one saves `min_gain`,
/// also if some robots are late.
ExchangePlan plan_exchange(const RoutePlanner& planner, const Mission& mission,
                           std::span<const RobotAbility> fleet, std::span<const RobotRoute> routes,
                           const Polyline& meeting, const RendezvousConfig& config,
                           const ExchangeRules& rules);

}  // namespace fleetmap::planning
