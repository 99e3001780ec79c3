#pragma once

#include <span>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::output {

/// A node where odometry saw it, and where it is placed.
struct CorrectedNode {
  Stamp stamp;
  Pose T_odom_base = Pose::Identity();
  Pose T_enu_base = Pose::Identity();
};

/// T_enu_base of a pose of the odometry: it moves along with the nodes before and after it, in proportion to
/// the time between them. `nodes` are those of its odometry frame, by time; without any, T_enu_odom places
/// it.
Pose corrected_pose(std::span<const CorrectedNode> nodes, const Pose& T_enu_odom,
                    const StampedPose& odometry);

}  // namespace fleetmap::output
