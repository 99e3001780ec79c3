#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/routes/route_planner.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Cost of a piece of the path for any robot; its time follows from the robot's speeds.
struct Travel {
  float length = std::numeric_limits<float>::infinity();  ///< m; infinite: no way
  float turn = 0.0f;                                      ///< rad, sum of all turns
  Travel operator+(const Travel& o) const { return {length + o.length, turn + o.turn}; }
};

/// s that `robot` needs.
double time_of(const Travel& travel, const RobotAbility& robot);
/// Wh that `robot` needs.
double energy_of(const Travel& travel, const RobotAbility& robot);

/// All ways between the ends of a mission's rows. Rows are counted in the mission's order; a row's end `2 *
/// row` is its first waypoint, `2 * row + 1` its last one. A robot that enters a row at one end leaves it at
/// the other.
class TravelCosts {
 public:
  /// Fails if a row can't be reached from the first one, or is blocked: says which and why.
  static Result<TravelCosts> create(const RoutePlanner& planner, const Mission& mission);

  std::size_t rows() const { return along_.size(); }
  Travel along(std::size_t row) const { return along_[row]; }
  /// From leaving a row at `exit` to entering another at `entry`, all turns included.
  Travel between(std::size_t exit, std::size_t entry) const { return between_[exit * 2 * rows() + entry]; }
  /// From a pose to entering at each of the ends.
  std::vector<Travel> from(const Pose2& pose) const;
  /// From leaving at each of the ends to a place.
  std::vector<Travel> to(const Eigen::Vector2d& place) const;

 private:
  explicit TravelCosts(RoutePlanner planner) : planner_(std::move(planner)) {}
  RoutePlanner planner_;
  std::vector<RoutePlanner::Anchor> ends_;
  std::vector<double> inward_;  ///< rad, heading on entering at each end
  std::vector<Travel> along_;
  std::vector<Travel> between_;
};

}  // namespace fleetmap::planning
