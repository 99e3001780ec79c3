#pragma once

#include <span>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// Least-squares T_enu_odom of nodes whose odometry poses are expressed in one common frame, weighted by the
/// covariance of G. Errors of one agent closer in time than `gps_correlation_time` count as one.
/// `T_common_node` runs parallel to `nodes`; `nodes` must not be empty.
Pose fit_to_global_poses(std::span<const Node> nodes, std::span<const Pose> T_common_node,
                         const LocalFrame& site, double gps_correlation_time);

}  // namespace fleetmap::graph
