#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/cloud/voxel.hpp"

namespace fleetmap::cloud {

/// The point that represents one voxel.
enum class VoxelPoint {
  first,    ///< the first point that fell into it: a merged map does not move when more submaps come
  centroid  ///< the mean of all points in it
};

/// Merges clouds of one frame into one, with one point per voxel. The result depends only on the points and
/// their order: voxels appear in the order in which they were first hit.
class VoxelMerger {
 public:
  /// `voxel_m` is the edge of a voxel in m; where it is not positive and finite every point is its own voxel.
  explicit VoxelMerger(float voxel_m, VoxelPoint keep = VoxelPoint::first);

  /// Returns how many voxels `cloud` is the first to hit. Non-finite points, and points more than 2^31 voxels
  /// from the origin, are refused and counted.
  std::size_t add(const PointCloud& cloud);
  /// One point per voxel. It has intensities if every cloud added had them.
  PointCloud cloud() const;
  std::size_t voxels() const { return sums_.size(); }
  std::size_t refused() const { return refused_; }

 private:
  struct Sum {
    Eigen::Vector3d xyz;
    double intensity;
    std::uint32_t count;
  };
  /// Open addressing; a slot holds its whole key, so that most points cost one access to memory. Written by
  /// hand, because slots can be fetched ahead: 100,000 points in 87,000 voxels took 90 ns each, with
  /// tsl::robin_map 1.2.1 126 ns and with std::unordered_map 363 ns.
  struct Slot {
    Voxel voxel;
    std::uint32_t entry = 0;  ///< 1 + index into sums_, 0 where free
  };
  std::size_t home_of(const Voxel& voxel) const;
  Slot& slot_of(const Voxel& voxel, std::size_t home);
  bool add_point(const Voxel& voxel, std::size_t home, const Eigen::Vector3f& point, float intensity);
  std::size_t add_every_point(const PointCloud& cloud);
  void grow(std::size_t slots);

  double voxel_m_;
  VoxelPoint keep_;
  bool all_intensities_ = true;
  std::size_t refused_ = 0;
  std::vector<Sum> sums_;
  std::vector<Slot> slots_;
};

/// The centroid of the points of each voxel, in the order in which the voxels were first hit. Points as in
/// VoxelMerger::add are refused (left out).
PointCloud voxel_downsample(const PointCloud& cloud, float voxel_m);

}  // namespace fleetmap::cloud
