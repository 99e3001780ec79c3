#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::planning {

/// Limits of the chassis, and sizes of the local field.
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
  double lateral_error = 3.0;     ///< m, that the path may lie beside the free lane (error of the position)
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

}  // namespace fleetmap::planning
