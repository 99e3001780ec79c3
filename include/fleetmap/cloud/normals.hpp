#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

struct NormalConfig {
  std::size_t neighbors = 15;     ///< nearest points, the point itself among them, at most 64
  float max_radius_m = 2.0f;      ///< m, neighbours further off do not count
  std::size_t min_neighbors = 5;  ///< with fewer there is no normal
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();  ///< m, normals point towards it
  Status validate() const;
};

struct Normals {
  std::vector<Eigen::Vector3f> normals;  ///< unit, or zero where there is none
  /// Least eigenvalue over the sum of the three: 0 on a plane, 1/3 in a ball of points; 1 where there is no
  /// normal.
  std::vector<float> variations;
};

/// Normals by principal component analysis of each point's neighbours. `tree` is over the points of `cloud`.
Normals estimate_normals(const PointCloud& cloud, const KdTree& tree, const NormalConfig& config);

/// The same for the points at `indices` only, in that order.
Normals estimate_normals(const PointCloud& cloud, const KdTree& tree, const NormalConfig& config,
                         const std::vector<std::size_t>& indices);

}  // namespace fleetmap::cloud
