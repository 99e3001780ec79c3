#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::eval {

/// The surface that a map is fitted to: normals run parallel to points; zero where it is not flat.
struct TruthPlanes {
  const std::vector<Eigen::Vector3f>& points;
  const std::vector<Eigen::Vector3f>& normals;
  const cloud::KdTree& tree;
};

/// T_truth_map by point-to-plane ICP from the identity, Gauss-Newton with Geman-McClure weights, a stage for
/// each of `max_distances` (m, of correspondences; the kernel is as wide). Apart from the registration that
/// is evaluated, so that neither shares the other's faults. Directions that nothing constrains stay as they
/// are.
Pose fit_to_truth(const TruthPlanes& truth, const std::vector<Eigen::Vector3f>& map,
                  std::span<const float> max_distances);

}  // namespace fleetmap::eval
