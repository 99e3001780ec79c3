#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Neighbourhood from which a normal is estimated.
struct NormalConfig {
  static constexpr std::size_t kMaxNeighbors = 64;
  std::size_t neighbors = 15;     ///< nearest points, the point itself among them, at most 64
  float max_radius_m = 2.0f;      ///< m, neighbours further off do not count
  std::size_t min_neighbors = 5;  ///< with fewer there is no normal
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();  ///< m, normals point towards it
  Status validate() const;
};

}  // namespace fleetmap::cloud
