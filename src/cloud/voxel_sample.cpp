#include "fleetmap/cloud/voxel_sample.hpp"

#include <algorithm>

namespace fleetmap::cloud {

VoxelSample::VoxelSample(std::size_t capacity) : capacity_(std::max<std::size_t>(1, capacity)) {}

void VoxelSample::add(const Voxel& voxel) {
  if (!belongs(voxel)) return;
  voxels_.insert(voxel);
  while (voxels_.size() > capacity_ && level_ < 63) {
    ++level_;
    std::erase_if(voxels_, [this](const Voxel& held) { return !belongs(held); });
  }
}

}  // namespace fleetmap::cloud
