#pragma once

#include <Eigen/Core>
#include <vector>

#include "fleetmap/agent/obstacle_config.hpp"

namespace fleetmap::agent {

/// The obstacles among points in base_link, in base_link (x forward, y left).
std::vector<Eigen::Vector2d> obstacles_among(const std::vector<Eigen::Vector3f>& points_base,
                                             const ObstacleConfig& config);

}  // namespace fleetmap::agent
