#pragma once

#include <cstddef>
#include <unordered_set>

#include "fleetmap/cloud/voxel.hpp"

namespace fleetmap::cloud {

/// A bounded uniform sample of the distinct voxels in a stream of points (adaptive sampling, Flajolet 1990).
/// A voxel belongs to it where the upper `level` bits of its hash are zero; when the sample is full, the
/// level rises. It depends on the set of voxels alone, not on how often or in which order they come.
class VoxelSample {
 public:
  explicit VoxelSample(std::size_t capacity);
  void add(const Voxel& voxel);

  struct Hash {
    std::size_t operator()(const Voxel& voxel) const { return static_cast<std::size_t>(hash_of(voxel)); }
  };
  const std::unordered_set<Voxel, Hash>& voxels() const { return voxels_; }
  /// Each voxel of the sample represents 2^level distinct ones; at level 0 the sample is all of them.
  unsigned level() const { return level_; }

 private:
  bool belongs(const Voxel& voxel) const { return level_ == 0 || hash_of(voxel) >> (64 - level_) == 0; }

  std::size_t capacity_;
  unsigned level_ = 0;
  std::unordered_set<Voxel, Hash> voxels_;
};

}  // namespace fleetmap::cloud
