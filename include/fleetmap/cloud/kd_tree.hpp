#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::cloud {

/// A point of the tree's cloud, with its squared distance to the query.
struct Neighbor {
  std::uint32_t index = 0;        ///< into the cloud that the tree was built from
  float squared_distance = 0.0f;  ///< m^2
  bool operator==(const Neighbor&) const = default;
};

/// Exact nearest-neighbour search over the points of one cloud, of which it keeps its own copy. Non-finite
/// points are never found; a non-finite query finds nothing. Queries may run concurrently.
class KdTree {
 public:
  explicit KdTree(const std::vector<Eigen::Vector3f>& points);
  explicit KdTree(const PointCloud& cloud) : KdTree(cloud.points) {}
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// Number of (finite) points that can be found.
  std::size_t size() const;
  /// Their indices in the cloud, sorted so that neighbours mostly follow each other: queries at all points of
  /// the cloud are fastest in this order, since most of what one reads the last one read as well.
  std::span<const std::uint32_t> order() const;
  /// The nearest point closer than `max_distance` (m).
  std::optional<Neighbor> nearest(const Eigen::Vector3f& query,
                                  float max_distance = std::numeric_limits<float>::infinity()) const;
  /// Fills `out` with the nearest points closer than `max_distance` (m), nearest first; returns how many
  /// there were: at most min(out.size(), size()).
  std::size_t knn(const Eigen::Vector3f& query, std::span<Neighbor> out,
                  float max_distance = std::numeric_limits<float>::infinity()) const;
  std::vector<Neighbor> knn(const Eigen::Vector3f& query, std::size_t k) const;
  /// All points closer than `radius` (m), nearest first, equal distances by index.
  std::vector<Neighbor> radius(const Eigen::Vector3f& query, float radius) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace fleetmap::cloud
