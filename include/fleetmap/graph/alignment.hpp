#pragma once

#include <cstdint>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::graph {

/// Result of registering the spherized clouds of two nodes (paper, section on spherized registration).
/// Immutable.
struct Alignment {
  NodeId i;             ///< target node
  NodeId j;             ///< source node
  AgentId computed_by;  ///< the agent that ran the registration: one of the two
  std::uint32_t seq =
      0;  ///< the seq-th alignment of `computed_by`, from 0 without gaps: (computed_by, seq) names it
  Pose T_i_j = Pose::Identity();  ///< maps base_link of node j into base_link of node i
  double rmse = 0.0;              ///< E_ij, inlier RMSE in m (Eq. 2)
  double inlier_fraction = 0.0;   ///< inliers over source points, [0, 1]
  Matrix6d covariance =
      Matrix6d::Identity();  ///< C_ij, inverse Fisher information, right tangent of T_i_j: [m, rad]
};

/// An alignment counts as good when E_ij is at most this (paper).
inline constexpr double kGoodRmse = 0.4;  ///< m

}  // namespace fleetmap::graph
