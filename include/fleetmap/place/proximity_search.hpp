#pragma once

#include <optional>

#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/place/ball_tree.hpp"
#include "fleetmap/place/proximity_config.hpp"

namespace fleetmap::place {

/// The standard deviation (m) of the position along the worst horizontal direction: the root of the larger
/// eigenvalue of the covariance's east-north block. Infinite if that block is not finite or has a negative
/// eigenvalue: nothing is known then.
double horizontal_sigma(const Matrix6d& C_ekf);

/// True if G has a position on Earth with a horizontal_sigma() of at most `max_sigma_m`.
bool has_known_position(const std::optional<GlobalPose>& G, double max_sigma_m);

/// r^i in metres (Eq. 1). An unknown uncertainty yields max_radius.
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
