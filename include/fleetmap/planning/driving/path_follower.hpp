#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

struct PathFollowerConfig {
  double max_speed = 1.5;         ///< m/s
  double max_reverse = 0.4;       ///< m/s, backing off
  double max_yaw_rate = 1.0;      ///< rad/s
  double acceleration = 1.0;      ///< m/s^2, speeding up
  double braking = 1.0;           ///< m/s^2, with which stopping distances are reckoned
  double reaction_time = 0.3;     ///< s, from a scan to the brakes
  double robot_radius = 0.35;     ///< m, around base_link
  double margin = 0.1;            ///< m, kept besides from every obstacle
  double wanted_clearance = 1.6;  ///< m, from base_link to obstacles where there is room
  double horizon = 5.5;           ///< m, looked ahead
  double lateral_doubt = 3.0;     ///< m, that the path may lie beside the free lane (error of the position)
  double lateral_weight = 0.25;   ///< m of detour that a metre beside the path is worth
  double corner_tolerance = 0.8;  ///< m, at which a corner of the path is reached
  double goal_tolerance = 0.5;    ///< m, at which the end of the path is reached
  double give_up_radius = 4.0;    ///< m: a blocked waypoint this near counts as reached after `give_up_after`
  double give_up_after = 6.0;     ///< s, without getting nearer
  double turn_in_place = 1.05;    ///< rad, heading error beyond which it turns on the spot
  double stuck_after = 15.0;      ///< s, without progress though commanded
  double stuck_distance = 0.5;    ///< m, along the path, that counts as progress
  Status validate() const;
};

struct Command {
  double forward_speed = 0.0;  ///< m/s
  double yaw_rate = 0.0;       ///< rad/s, counter-clockwise
};

/// Drives along a path whose position on the ground is known only to a few metres, between obstacles that are
/// seen to the centimetre: around the robot a field of the cost to get on along the path is computed over
/// what the last scan shows (Brock and Khatib's global dynamic window), and of the arcs that it can drive
/// without touching anything the one that leads down the field fastest is taken. Where the path runs beside
/// the free lane, the robot keeps to the middle of the lane. Not thread-safe; an update takes well below a
/// millisecond.
class PathFollower {
 public:
  /// Throws std::invalid_argument if the config is not valid.
  explicit PathFollower(const PathFollowerConfig& config = {});
  ~PathFollower();
  PathFollower(PathFollower&&) noexcept;
  PathFollower& operator=(PathFollower&&) noexcept;

  /// ENU, m. Points that are not finite are left out; an empty path stands still and is finished.
  void set_path(Polyline path);
  /// `obstacles`: points at robot height in base_link (x forward, y left), m. A pose that is not finite stops
  /// the robot.
  Command update(const Pose2& pose, double speed, const std::vector<Eigen::Vector2d>& obstacles_in_base,
                 Stamp now);

  /// The robot has to stand for a reason that is not its path's: no progress counts from `now` on.
  void pause(Stamp now);

  double progress() const;   ///< m along the path
  double remaining() const;  ///< m
  bool finished() const;
  /// Commanded for `stuck_after` without getting on.
  bool stuck(Stamp now) const;
  /// The end of the path was given up because something stands on it.
  bool gave_up_end() const;
  const PathFollowerConfig& config() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::planning
