#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/planning/division/rendezvous.hpp"
#include "fleetmap/planning/division/timed_path.hpp"

namespace fleetmap::planning {

/// A part of a robot's drive.
struct Piece {
  TimedPath path;                   ///< its times count from when it begins
  double length = 0.0;              ///< m
  std::size_t after = 0;            ///< rows of the route that are driven before it
  Pose2 begin;                      ///< where the robot stands before it
  std::optional<std::size_t> stop;  ///< index of the stop at its end
};
using Itinerary = std::vector<Piece>;

struct Forecast {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double completion = kNever;                  ///< s, all are at the end and hold all maps
  std::vector<double> arrivals;                ///< s, of each robot at its end
  std::vector<double> lengths;                 ///< m, driven by each robot
  std::vector<std::vector<double>> begins;     ///< s, of each piece of each robot
  std::vector<std::array<double, 2>> at_stop;  ///< s, arrivals at each stop, the lower robot first
  std::vector<double> leave;                   ///< s, of each stop
  double bytes_total = 0.0;
  double bytes_in_passing = 0.0;
  double bytes_at_stops = 0.0;
};

/// Robots that need longer than planned.
struct Pace {
  double factor = 1.0;    ///< of the time that slow robots need
  std::size_t which = 0;  ///< robots k with k % 2 == which are slow
  double of(std::size_t robot) const { return robot % 2 == which ? factor : 1.0; }
};

/// Steps through the drives of the whole fleet. Two at a stop go on when both are there and hold the same,
/// `stop_overhead` later. Ends without a completion at `give_up` (s), or if not all are in reach at the end.
Forecast forecast_exchange(std::span<const Itinerary> fleet, std::size_t stops,
                           const RendezvousConfig& config, double give_up, const Pace& pace = {});

}  // namespace fleetmap::planning
