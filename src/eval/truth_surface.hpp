#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::eval {

/// Foot point of a map point on the true surface.
struct Foot {
  std::uint32_t truth = 0;        ///< index of the nearest truth point
  bool found = false;             ///< within the cap
  float point_distance = 0.0f;    ///< m, to that point
  float surface_distance = 0.0f;  ///< m, to the disc around it, or to the point where it is not flat
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the truth there; zero where it is not flat
};

/// The surface that a cloud of truth points samples.
class TruthSurface {
 public:
  /// `truth` must be finite and not empty.
  explicit TruthSurface(cloud::PointCloud truth);

  const cloud::PointCloud& cloud() const { return cloud_; }
  const cloud::KdTree& tree() const { return tree_; }
  /// m, median distance to the fourth neighbour: the grid's edge where truth is sampled on a grid.
  float spacing() const { return spacing_; }
  /// Normals at `indices`; zero where the surface is not flat.
  std::vector<Eigen::Vector3f> normals_at(const std::vector<std::size_t>& indices) const;
  /// Foot points of `points`; those with no truth point within `cap` (m) are not found.
  std::vector<Foot> feet_of(const std::vector<Eigen::Vector3f>& points, float cap) const;

 private:
  cloud::PointCloud cloud_;
  cloud::KdTree tree_;
  float spacing_;
};

}  // namespace fleetmap::eval
