#pragma once

#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/place/ball_tree.hpp"

namespace fleetmap::place {

/// How the covariance of the EKF enters Eq. 1 as one number.
enum class Uncertainty {
  variance,  ///< the larger eigenvalue of the horizontal covariance, m^2: Eq. 1 as the paper prints it
  sigma,     ///< its root, m
};
const char* to_string(Uncertainty uncertainty);

/// Eq. 1: r^i = clamp(C_ekf^i * r, r_min, r_max).
struct ProximityConfig {
  Uncertainty uncertainty = Uncertainty::sigma;
  double radius_scale = 10.0;  ///< r: metres of search radius per unit of C_ekf^i
  double min_radius = 20.0;    ///< m, r_min of the paper's experiments
  double max_radius = 30.0;    ///< m, r_max of the paper's experiments

  Status validate() const;
};

/// The standard deviation (m) of the position along the worst horizontal direction: the root of the larger
/// eigenvalue of the covariance's east-north block. Infinite if that block is not finite or has a negative
/// eigenvalue: nothing is known then.
double horizontal_sigma(const Matrix6d& C_ekf);

/// G is there and tells a place on Earth, to `max_sigma_m` (horizontal_sigma) or better.
bool tells_place(const std::optional<GlobalPose>& G, double max_sigma_m);

/// r^i in metres (Eq. 1). An unknown uncertainty gives max_radius.
double search_radius(double horizontal_sigma_m, const ProximityConfig& config);
double search_radius(const Matrix6d& C_ekf, const ProximityConfig& config);

/// The answer of Alg. 2.
struct Proximity {
  Neighbor nearest;
  double radius = 0.0;  ///< m, r^i
};

/// Alg. 2, minimal proximity search: R_j has received the node (G^i, O^i) of R_i and answers with its own
/// nearest node if that lies within r^i of Eq. 1 (inclusive).
std::optional<Proximity> find_proximity(const BallTree& own_nodes, const GlobalPose& G_i,
                                        const ProximityConfig& config);

}  // namespace fleetmap::place
