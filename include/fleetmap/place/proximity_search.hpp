#pragma once

#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/place/ball_tree.hpp"

namespace fleetmap::place {

/// Eq. 1: r^i = clamp(C_ekf^i * r, r_min, r_max).
struct ProximityConfig {
  double radius_per_sigma = 10.0;  ///< r: metres of search radius per metre of horizontal 1-sigma of the EKF
  double min_radius = 20.0;        ///< m, r_min
  double max_radius = 30.0;        ///< m, r_max

  Status validate() const;
};

/// C_ekf^i of Eq. 1 as one number: the standard deviation (m) of the position along the worst horizontal
/// direction, that is the root of the larger eigenvalue of the covariance's east-north block. Infinite if
/// that block is not finite or has a negative eigenvalue: nothing is known then.
double horizontal_sigma(const Matrix6d& C_ekf);

/// G is there and tells a place on Earth, to `max_sigma_m` (horizontal_sigma) or better.
bool tells_place(const std::optional<GlobalPose>& G, double max_sigma_m);

/// r^i in metres. An unknown uncertainty gives max_radius.
double search_radius(double horizontal_sigma_m, const ProximityConfig& config);
double search_radius(const Matrix6d& C_ekf, const ProximityConfig& config);

/// The nearest node of `tree` to `point` if it lies within `radius_m` (inclusive).
std::optional<Neighbor> nearest_within(const BallTree& tree, const GeoPoint& point, double radius_m);

/// Alg. 2, minimal proximity search: R_j has received the node (G^i, O^i) of R_i and answers with its own
/// nearest node if that lies within r^i of Eq. 1.
std::optional<Neighbor> find_proximity(const BallTree& own_nodes, const GlobalPose& G_i,
                                       const ProximityConfig& config);

}  // namespace fleetmap::place
