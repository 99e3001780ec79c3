#pragma once

#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Places at which a robot was stuck lately. Obstacles that the site's drawing lacks are found only while
/// driving; later routes lead around them.
class BlockedPlaces {
 public:
  static constexpr std::size_t kMaxPlaces = 12;

  /// The robot at `position` is stuck `progress` (m) along `path`: adds the place ahead of it on the path. A
  /// place that is right beside the robot is left out, since the robot is off its path then.
  void add(const Polyline& path, double progress, const Eigen::Vector2d& position, Stamp now);
  /// A way around the places, or through them if there is no other: the obstacle may be gone. Places older
  /// than five minutes are dropped.
  Result<Polyline> route(const RoutePlanner& planner, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         Stamp now);

  std::span<const Blockage> places() const { return places_; }

 private:
  void remove_oldest();

  std::vector<Blockage> places_;
  std::vector<Stamp> added_;  ///< one a place, rising
};

}  // namespace fleetmap::planning
