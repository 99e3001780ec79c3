#pragma once

#include <chrono>

#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// Limits of delay and uncertainty beyond which DriveGuard stops the robot.
struct DriveGuardConfig {
  /// Longest time since the last scan, the odometry's last result and the last pose. A LiDAR of 5 Hz may be
  /// 60 ms late; with kPeriod the command to stop comes at most 280 ms after the last of either, which leaves
  /// 20 ms of the promised 300 ms.
  Duration patience = std::chrono::milliseconds(260);
  /// Longest time from the arrival of a scan to the odometry's result; a later result is ignored.
  Duration max_latency = std::chrono::milliseconds(300);
  double max_position_sigma = 5.0;  ///< m, horizontal, 1 sigma of G; beyond, its lane is uncertain
};

}  // namespace fleetmap::agent
