#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::cloud {

PointCloud transformed(const PointCloud& cloud_b, const Pose& T_a_b) {
  PointCloud cloud_a;
  cloud_a.points.reserve(cloud_b.size());
  for (const Eigen::Vector3f& p : cloud_b.points) {
    cloud_a.points.emplace_back((T_a_b * p.cast<double>()).cast<float>());
  }
  cloud_a.intensities = cloud_b.intensities;
  return cloud_a;
}

void append(PointCloud& cloud, const PointCloud& other) {
  if (other.empty()) return;
  const bool keep_intensities = other.has_intensities() && (cloud.empty() || cloud.has_intensities());
  if (cloud.empty() || !keep_intensities) cloud.intensities.clear();
  cloud.points.insert(cloud.points.end(), other.points.begin(), other.points.end());
  if (keep_intensities) {
    cloud.intensities.insert(cloud.intensities.end(), other.intensities.begin(), other.intensities.end());
  }
}

PointCloud select(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  PointCloud selected;
  selected.points.reserve(indices.size());
  for (const std::size_t i : indices) selected.points.push_back(cloud.points[i]);
  if (cloud.has_intensities()) {
    selected.intensities.reserve(indices.size());
    for (const std::size_t i : indices) selected.intensities.push_back(cloud.intensities[i]);
  }
  return selected;
}

std::size_t remove_non_finite(PointCloud& cloud) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    cloud.points[kept] = cloud.points[i];
    if (cloud.has_intensities()) cloud.intensities[kept] = cloud.intensities[i];
    ++kept;
  }
  const std::size_t removed = cloud.size() - kept;
  cloud.points.resize(kept);
  if (cloud.has_intensities()) cloud.intensities.resize(kept);
  return removed;
}

}  // namespace fleetmap::cloud
