#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/ground_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Indices of a cloud's points, divided into ground and the rest.
struct GroundSplit {
  std::vector<std::size_t> kept;    ///< ascending
  std::vector<std::size_t> ground;  ///< ascending
  std::size_t refused = 0;          ///< non-finite points, in neither
};

/// Separates ground from objects. The lowest points of a grid of cells (in the plane normal to `up`) are
/// fitted with small planes; planes that continue each other within slope, step and slope change limits join
/// into surfaces; a surface above neighbouring surfaces (a roof, a table of panels) is no ground. So slopes
/// and rolling terrain are removed, and walls, posts and panels remain; a cloud without ground loses nothing.
GroundSplit split_ground(const PointCloud& cloud, const GroundConfig& config);

}  // namespace fleetmap::cloud
