#include "fleetmap/cloud/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "fleetmap/cloud/kd_tree.hpp"

namespace fleetmap::cloud {
namespace {

// Against rounding in bounds of distances.
constexpr float kSlack = 1.001f;
constexpr float kSlackM = 1e-3f;

/// Mean distance of each point to its neighbours in m; negative where it has none.
std::vector<double> mean_distances(const PointCloud& cloud, std::size_t neighbors) {
  const KdTree tree(cloud);
  std::array<Neighbor, OutlierConfig::kMaxNeighbors + 1> buffer;
  const std::span<Neighbor> wanted(buffer.data(), std::min(neighbors, OutlierConfig::kMaxNeighbors) + 1);
  std::vector<double> means(cloud.size(), -1.0);
  // Neighbours of the previous point bound the search around this one.
  std::optional<Eigen::Vector3f> last;
  float last_reach = 0.0f;
  for (const std::uint32_t i : tree.order()) {
    const Eigen::Vector3f& point = cloud.points[i];
    const float reach = last ? kSlack * (last_reach + (point - *last).norm()) + kSlackM
                             : std::numeric_limits<float>::infinity();
    const std::size_t found = tree.knn(point, wanted, reach);
    if (found < 2) continue;
    last = point;
    last_reach = std::sqrt(wanted[found - 1].squared_distance);
    double sum = 0.0;
    for (std::size_t k = 1; k < found; ++k) sum += std::sqrt(static_cast<double>(wanted[k].squared_distance));
    means[i] = sum / static_cast<double>(found - 1);
  }
  return means;
}

}  // namespace

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
