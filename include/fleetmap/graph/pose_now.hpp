#pragma once

#include <optional>

#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/graph/placed_fleet.hpp"

namespace fleetmap::graph {

/// The poses of a robot at a scan.
struct PoseNow {
  Stamp stamp;                          ///< of the scan
  Pose T_odom_base = Pose::Identity();  ///< O
  std::optional<GlobalPose> G;
  std::optional<PlacedFrame> placed;  ///< the odometry's frame, once the fleet's graph has placed it
};

}  // namespace fleetmap::graph
