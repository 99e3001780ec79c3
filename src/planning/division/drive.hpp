#pragma once

#include "fleetmap/planning/division/timed_path.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Puts lines one behind the other and notes when a robot, which turns on the spot, is where.
class Drive {
 public:
  Drive(const RobotAbility& robot, const Pose2& from)
      : robot_(&robot), yaw_(from.yaw), path_{{from.position}, {0.0}} {}

  void add(const Polyline& line);
  /// Straight or around what is in the way; nothing if there is no way.
  void add_way(const RoutePlanner& planner, const Eigen::Vector2d& to);
  void add_row(const RoutePlanner& planner, const Mission& mission, const RowVisit& visit);
  /// Pose after everything that was added.
  Pose2 pose() const { return {path_.points.back(), yaw_}; }
  const TimedPath& path() const { return path_; }

 private:
  const RobotAbility* robot_;
  double yaw_;
  TimedPath path_;
};

}  // namespace fleetmap::planning
