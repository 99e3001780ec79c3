#include "fleetmap/registration/fpfh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "neighbor_pairs.hpp"

namespace fleetmap::registration {
namespace {

constexpr int kBins = 11;

int bin_of(float value, float low, float high) {
  return std::clamp(static_cast<int>(static_cast<float>(kBins) * (value - low) / (high - low)), 0, kBins - 1);
}

/// Bins of the three angles of Rusu's Darboux frame; the same whichever of the two points comes first.
std::array<int, 3> pair_bins(const Eigen::Vector3f& line, float distance, Eigen::Vector3f n1,
                             Eigen::Vector3f n2) {
  Eigen::Vector3f d = line / distance;
  float phi = n1.dot(d);
  if (std::abs(phi) < std::abs(n2.dot(d))) {
    std::swap(n1, n2);
    d = -d;
    phi = n1.dot(d);
  }
  Eigen::Vector3f v = d.cross(n1);
  const float length = v.norm();
  if (length < 1e-6f) return {kBins / 2, bin_of(phi, -1.0f, 1.0f), kBins / 2};
  v /= length;
  const Eigen::Vector3f w = n1.cross(v);
  const float theta = std::atan2(w.dot(n2), n1.dot(n2));
  constexpr float pi = std::numbers::pi_v<float>;
  return {bin_of(theta, -pi, pi), bin_of(v.dot(n2), -1.0f, 1.0f), bin_of(phi, -1.0f, 1.0f)};
}

}  // namespace

Features compute_fpfh(const cloud::PointCloud& cloud, const cloud::Normals& normals, float radius_m) {
  const auto count = static_cast<Eigen::Index>(cloud.size());
  Features simple = Features::Zero(kFpfhSize, count);
  const std::vector<NeighborPair> pairs = neighbor_pairs(cloud.points, radius_m);
  std::vector<std::uint32_t> neighbors(cloud.size(), 0);
  for (const NeighborPair& pair : pairs) {
    const Eigen::Vector3f& n1 = normals.normals[pair.a];
    const Eigen::Vector3f& n2 = normals.normals[pair.b];
    if (pair.distance < 1e-4f || n1.isZero() || n2.isZero()) continue;
    const auto bins = pair_bins(cloud.points[pair.b] - cloud.points[pair.a], pair.distance, n1, n2);
    for (int k = 0; k < 3; ++k) {
      simple(kBins * k + bins[static_cast<std::size_t>(k)], static_cast<Eigen::Index>(pair.a)) += 1.0f;
      simple(kBins * k + bins[static_cast<std::size_t>(k)], static_cast<Eigen::Index>(pair.b)) += 1.0f;
    }
    ++neighbors[pair.a];
    ++neighbors[pair.b];
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto n = neighbors[static_cast<std::size_t>(i)];
    if (n > 0) simple.col(i) /= static_cast<float>(n);
  }
  Features features = simple;
  for (const NeighborPair& pair : pairs) {
    const auto a = static_cast<Eigen::Index>(pair.a);
    const auto b = static_cast<Eigen::Index>(pair.b);
    if (neighbors[pair.a] == 0 || neighbors[pair.b] == 0) continue;
    const float weight = radius_m / std::max(pair.distance, 0.05f * radius_m);
    features.col(a) += weight / static_cast<float>(neighbors[pair.a]) * simple.col(b);
    features.col(b) += weight / static_cast<float>(neighbors[pair.b]) * simple.col(a);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const float sum = features.col(i).sum();
    if (neighbors[static_cast<std::size_t>(i)] < 5 || !(sum > 0.0f)) {
      features.col(i).setZero();
    } else {
      features.col(i) = (features.col(i) / sum).cwiseSqrt();
    }
  }
  return features;
}

}  // namespace fleetmap::registration
