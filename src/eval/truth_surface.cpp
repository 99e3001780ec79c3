#include "truth_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fleetmap::eval {
namespace {

constexpr std::size_t kSpacingSamples = 10'000;
/// Least eigenvalue over the sum of the three, above which a neighbourhood is an edge or a bush.
constexpr float kFlat = 0.02f;
constexpr std::size_t kNeighbors = 12;
constexpr float kLargestDisc = 0.25f;  // m

float spacing_of(const cloud::PointCloud& cloud, const cloud::KdTree& tree) {
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSpacingSamples);
  std::array<cloud::Neighbor, 5> buffer;
  std::vector<float> distances;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (tree.knn(cloud.points[i], std::span(buffer)) < buffer.size()) continue;
    distances.push_back(std::sqrt(buffer.back().squared_distance));
  }
  if (distances.empty()) return 0.0f;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

TruthSurface::TruthSurface(cloud::PointCloud truth)
    : cloud_(std::move(truth)), tree_(cloud_), spacing_(spacing_of(cloud_, tree_)) {}

std::vector<Eigen::Vector3f> TruthSurface::normals_at(const std::vector<std::size_t>& indices) const {
  cloud::NormalConfig config;
  config.neighbors = kNeighbors;
  config.max_radius_m = std::max(0.05f, 4.0f * spacing_);
  cloud::Normals normals = cloud::estimate_normals(cloud_, tree_, config, indices);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    if (normals.variations[k] > kFlat) normals.normals[k].setZero();
  }
  return std::move(normals.normals);
}

std::vector<Foot> TruthSurface::feet_of(const std::vector<Eigen::Vector3f>& points, float cap) const {
  std::vector<Foot> feet(points.size());
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto nearest = tree_.nearest(points[i], cap);
    if (!nearest) continue;
    const float distance = std::sqrt(nearest->squared_distance);
    feet[i] = {nearest->index, true, distance, distance, Eigen::Vector3f::Zero()};
    asked.push_back(nearest->index);
  }
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
  const std::vector<Eigen::Vector3f> normals = normals_at(asked);
  const float disc = std::min(spacing_, kLargestDisc);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!feet[i].found) continue;
    const auto at = std::lower_bound(asked.begin(), asked.end(), feet[i].truth) - asked.begin();
    const Eigen::Vector3f& n = normals[static_cast<std::size_t>(at)];
    if (n.isZero()) continue;
    feet[i].normal = n;
    const Eigen::Vector3f d = points[i] - cloud_.points[feet[i].truth];
    const float along = n.dot(d);
    const float aside = std::max(0.0f, (d - along * n).norm() - disc);
    feet[i].surface_distance = std::hypot(along, aside);
  }
  return feet;
}

}  // namespace fleetmap::eval
