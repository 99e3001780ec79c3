#include "fleetmap/cloud/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fleetmap/cloud/kd_tree.hpp"

namespace fleetmap::cloud {
namespace {

constexpr std::size_t kMaxNeighbors = 63;

/// Mean distance of each point to its neighbours in m; negative where it has none.
std::vector<double> mean_distances(const PointCloud& cloud, std::size_t neighbors) {
  const KdTree tree(cloud);
  std::array<Neighbor, kMaxNeighbors + 1> buffer;
  const std::span<Neighbor> wanted(buffer.data(), std::min(neighbors, kMaxNeighbors) + 1);
  std::vector<double> means(cloud.size(), -1.0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t found = tree.knn(cloud.points[i], wanted);
    if (found < 2) continue;
    double sum = 0.0;
    for (std::size_t k = 1; k < found; ++k) sum += std::sqrt(static_cast<double>(wanted[k].squared_distance));
    means[i] = sum / static_cast<double>(found - 1);
  }
  return means;
}

}  // namespace

Status OutlierConfig::validate() const {
  if (neighbors < 1 || neighbors > kMaxNeighbors) return failure("neighbors must be in [1, 63]");
  if (!(sigmas >= 0.0)) return failure("sigmas must not be negative");
  return {};
}

OutlierSplit split_outliers(const PointCloud& cloud, const OutlierConfig& config) {
  const std::vector<double> means = mean_distances(cloud, config.neighbors);
  double sum = 0.0;
  double count = 0.0;
  for (const double mean : means) {
    if (mean < 0.0) continue;
    sum += mean;
    count += 1.0;
  }
  const double average = count > 0.0 ? sum / count : 0.0;
  double squares = 0.0;
  for (const double mean : means) squares += mean < 0.0 ? 0.0 : (mean - average) * (mean - average);
  const double limit = average + config.sigmas * (count > 1.0 ? std::sqrt(squares / (count - 1.0)) : 0.0);
  OutlierSplit split;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool keep = cloud.points[i].allFinite() && means[i] <= limit;
    (keep ? split.kept : split.removed).push_back(i);
  }
  return split;
}

}  // namespace fleetmap::cloud
