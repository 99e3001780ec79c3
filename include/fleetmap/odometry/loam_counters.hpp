#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace fleetmap::odometry {

/// CPU of Loam's stages, s, in the order in which a scan passes them.
struct StageTimes {
  double sweep = 0.0;     ///< rings and times of the points
  double features = 0.0;  ///< plane points, posts and borders
  double thinning = 0.0;  ///< to evenly spread features
  double matching = 0.0;  ///< with the local map
  double mapping = 0.0;   ///< scans entering the local map, and its pruning
  double points = 0.0;    ///< motion compensation of all returns

  /// (name, s) of all.
  std::array<std::pair<const char*, double>, 6> named() const {
    return {{{"sweep", sweep},
             {"features", features},
             {"thinning", thinning},
             {"matching", matching},
             {"mapping", mapping},
             {"points", points}}};
  }
};

/// Loam's running totals since it was built.
struct LoamCounters {
  std::uint64_t scans = 0;             ///< handed to add_scan()
  std::uint64_t updates = 0;           ///< that gave an update
  std::uint64_t refused_time = 0;      ///< not later than the scan before
  std::uint64_t refused_points = 0;    ///< empty, or too few usable points
  std::uint64_t refused_repeated = 0;  ///< the very points of the scan before, though the robot moves
  std::uint64_t lost = 0;              ///< updates that are predictions
  std::uint64_t map_restarts = 0;      ///< new local maps after being lost for long
  std::uint64_t map_overflows = 0;     ///< the local map was full; what lay farthest was forgotten
  std::uint64_t clock_resets = 0;      ///< the clock went backwards and stayed there
  std::uint64_t points_non_finite = 0;
  std::uint64_t points_out_of_range = 0;
  std::uint64_t points_bad_time = 0;
  std::uint64_t rings_ignored = 0;  ///< scans whose ring field contradicts their points
  std::uint64_t times_ignored = 0;  ///< scans whose times cannot be theirs
  std::uint64_t imu_dropped = 0;    ///< samples: not finite, or out of order
  std::uint64_t wheel_dropped = 0;
  StageTimes cpu;
};

}  // namespace fleetmap::odometry
