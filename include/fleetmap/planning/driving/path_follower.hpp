#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/planning/driving/path_follower_config.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Velocity of base_link that the chassis is to drive.
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
