#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::testing {

/// Ground and 500 walls on 260 m x 260 m, none like another, in ENU.
const std::vector<Eigen::Vector3f>& walled_site();

/// A node there without G, with an odometry frame that is anywhere.
graph::Node node_at_walls(const AgentId& agent, std::uint32_t seq, const Pose& T_enu_odom,
                          const Pose& T_enu_base);

}  // namespace fleetmap::testing
