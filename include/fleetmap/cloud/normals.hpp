#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/normal_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Normals and surface variations (Pauly et al. 2002) of a cloud's points, in its order and frame.
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
