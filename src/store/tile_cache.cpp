#include "fleetmap/store/tile_cache.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::store {

std::size_t bytes_of(const cloud::PointCloud& cloud) {
  return cloud.points.size() * sizeof(Eigen::Vector3f) + cloud.intensities.size() * sizeof(float);
}

cloud::PointCloud TileCache::take(std::size_t submap, std::size_t tile) {
  Parts& parts = held_.at(submap);
  const auto found = parts.find(tile);
  if (found == parts.end()) return {};
  cloud::PointCloud points = std::move(found->second);
  bytes_ -= bytes_of(points);
  parts.erase(found);
  if (parts.empty()) held_.erase(submap);
  return points;
}

void TileCache::put(std::size_t submap, Parts parts) {
  if (parts.empty()) return;
  for (const auto& [tile, points] : parts) bytes_ += bytes_of(points);
  held_.emplace(submap, std::move(parts));
  while (bytes_ > max_bytes_) evict_one();
  peak_bytes_ = std::max(peak_bytes_, bytes_);
}

void TileCache::evict_one() {
  const auto last =
      std::ranges::max_element(held_, {}, [](const auto& entry) { return entry.second.begin()->first; });
  for (const auto& [tile, points] : last->second) bytes_ -= bytes_of(points);
  held_.erase(last);
}

void TileCache::clear() {
  held_.clear();
  bytes_ = 0;
}

}  // namespace fleetmap::store
