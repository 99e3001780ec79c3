#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::odometry {

/// Detects a LiDAR driver that hangs: it sends the points of the previous scan under a new stamp while the
/// robot moves, so they hold no motion. The noise of a real LiDAR differs from scan to scan; a simulated one
/// without noise repeats its points while the robot stands still.
class FrozenScanCheck {
 public:
  /// True if `scan` must be refused: it repeats the previous one, and the robot has moved (`robot_moves`) at
  /// any time since the points began to repeat.
  bool frozen(const sensor::Scan& scan, bool robot_moves);
  /// Length of the run of repeated scans that ended just before the last scan.
  int repeated_before() const { return repeated_before_; }

 private:
  std::vector<std::uint32_t> compared_;  ///< bits of some coordinates of the last scan
  std::size_t compared_of_ = 0;          ///< its number of points
  bool frozen_ = false;
  int repeated_in_a_row_ = 0;
  int repeated_before_ = 0;
};

}  // namespace fleetmap::odometry
