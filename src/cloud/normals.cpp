#include "fleetmap/cloud/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace fleetmap::cloud {
namespace {

/// Covariance of the neighbours about their mean, relative to `origin` so that floats far from zero do no
/// harm.
Eigen::Matrix3d covariance_of(const PointCloud& cloud, std::span<const Neighbor> neighbors,
                              const Eigen::Vector3f& origin) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Neighbor& neighbor : neighbors) {
    const Eigen::Vector3d d = (cloud.points[neighbor.index] - origin).cast<double>();
    sum += d;
    squares += d * d.transpose();
  }
  const auto n = static_cast<double>(neighbors.size());
  return squares / n - (sum / n) * (sum / n).transpose();
}

}  // namespace

Normals estimate_normals(const PointCloud& cloud, const KdTree& tree, const NormalConfig& config,
                         const std::vector<std::size_t>& indices) {
  Normals result;
  result.normals.assign(indices.size(), Eigen::Vector3f::Zero());
  result.variations.assign(indices.size(), 1.0f);
  std::array<Neighbor, NormalConfig::kMaxNeighbors> buffer;
  const std::span<Neighbor> wanted(buffer.data(), std::min(config.neighbors, NormalConfig::kMaxNeighbors));
  const float squared_radius = config.max_radius_m * config.max_radius_m;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const Eigen::Vector3f& point = cloud.points[indices[k]];
    std::size_t found = tree.knn(point, wanted);
    while (found > 0 && wanted[found - 1].squared_distance > squared_radius) --found;
    if (found < std::max<std::size_t>(3, config.min_neighbors)) continue;
    solver.computeDirect(covariance_of(cloud, wanted.first(found), point));
    const Eigen::Vector3d eigenvalues = solver.eigenvalues().cwiseMax(0.0);
    // On a line (or a single spot) any perpendicular is an eigenvector: there is no normal to speak of.
    if (!(eigenvalues[1] > 1e-4 * eigenvalues[2])) continue;
    const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
    result.normals[k] = normal.dot(config.viewpoint - point) < 0.0f ? Eigen::Vector3f(-normal) : normal;
    result.variations[k] = static_cast<float>(eigenvalues[0] / eigenvalues.sum());
  }
  return result;
}

Normals estimate_normals(const PointCloud& cloud, const KdTree& tree, const NormalConfig& config) {
  std::vector<std::size_t> all(cloud.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return estimate_normals(cloud, tree, config, all);
}

}  // namespace fleetmap::cloud
