#pragma once

#include <cstddef>
#include <map>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::store {

/// Keeps the points of submaps that later tiles need, within a bound of bytes. Tiles are merged in ascending
/// order, so the next use of each submap is known, and the submap with the latest next use is evicted (Belady
/// 1966).
class TileCache {
 public:
  /// The points of one submap in each tile.
  using Parts = std::map<std::size_t, cloud::PointCloud>;

  explicit TileCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  bool holds(std::size_t submap) const { return held_.contains(submap); }
  /// Removes what a held submap has in `tile`; empty where it has nothing there.
  cloud::PointCloud take(std::size_t submap, std::size_t tile);
  /// Keeps `parts` of a submap that is not held, or evicts them again.
  void put(std::size_t submap, Parts parts);
  void clear();
  std::size_t bytes() const { return bytes_; }
  std::size_t peak_bytes() const { return peak_bytes_; }

 private:
  void evict_one();

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::size_t peak_bytes_ = 0;
  std::map<std::size_t, Parts> held_;  ///< none without parts
};

std::size_t bytes_of(const cloud::PointCloud& cloud);

}  // namespace fleetmap::store
