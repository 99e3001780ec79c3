#pragma once

namespace fleetmap::agent {

/// Which LiDAR returns are obstacles: those at the height of the robot's body, seen from base_link.
struct ObstacleConfig {
  double min_height = 0.2;   ///< m above the ground under the robot; what is lower is driven over
  double max_height = 1.0;   ///< m; what is higher is driven under
  double slope = 0.12;       ///< m a metre: how much the ground may rise with distance
  double reach = 6.0;        ///< m
  double spacing = 0.1;      ///< m, at most one obstacle in a cell of this
  double base_height = 0.1;  ///< m, of base_link above the ground
};

}  // namespace fleetmap::agent
