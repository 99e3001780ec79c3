#include "fleetmap/cloud/voxel_grid.hpp"

#include <array>
#include <bit>
#include <cmath>

namespace fleetmap::cloud {
namespace {

/// Points whose places in the table are fetched ahead: the table of a large map lies outside of every cache.
constexpr std::size_t kAhead = 16;

}  // namespace

VoxelMerger::VoxelMerger(float voxel_m, VoxelPoint keep)
    : voxel_m_(std::isfinite(voxel_m) && voxel_m > 0.0f ? static_cast<double>(voxel_m) : 0.0), keep_(keep) {}

std::size_t VoxelMerger::home_of(const Voxel& voxel) const {
  return static_cast<std::size_t>(hash_of(voxel)) & (slots_.size() - 1);
}

VoxelMerger::Slot& VoxelMerger::slot_of(const Voxel& voxel, std::size_t home) {
  const std::size_t mask = slots_.size() - 1;
  while (slots_[home].entry != 0 && slots_[home].voxel != voxel) home = (home + 1) & mask;
  return slots_[home];
}

void VoxelMerger::grow(std::size_t slots) {
  std::vector<Slot> old(std::bit_ceil(slots));
  std::swap(old, slots_);
  for (const Slot& slot : old) {
    if (slot.entry != 0) slot_of(slot.voxel, home_of(slot.voxel)) = slot;
  }
}

bool VoxelMerger::add_point(const Voxel& voxel, std::size_t home, const Eigen::Vector3f& point,
                            float intensity) {
  Slot& slot = slot_of(voxel, home);
  if (slot.entry == 0) {
    sums_.push_back({point.cast<double>(), static_cast<double>(intensity), 1});
    slot = {voxel, static_cast<std::uint32_t>(sums_.size())};
    return true;
  }
  if (keep_ == VoxelPoint::centroid) {
    Sum& sum = sums_[slot.entry - 1];
    sum.xyz += point.cast<double>();
    sum.intensity += static_cast<double>(intensity);
    ++sum.count;
  }
  return false;
}

std::size_t VoxelMerger::add_every_point(const PointCloud& cloud) {
  const std::size_t before = sums_.size();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) {
      ++refused_;
      continue;
    }
    sums_.push_back({cloud.points[i].cast<double>(),
                     static_cast<double>(cloud.has_intensities() ? cloud.intensities[i] : 0.0f), 1});
  }
  return sums_.size() - before;
}

std::size_t VoxelMerger::add(const PointCloud& cloud) {
  if (cloud.empty()) return 0;
  all_intensities_ = all_intensities_ && cloud.has_intensities();
  if (voxel_m_ == 0.0) return add_every_point(cloud);
  struct Ahead {
    Voxel voxel;
    std::size_t home = 0;
    std::size_t point = 0;
  };
  std::array<Ahead, kAhead> block;
  std::size_t added = 0;
  for (std::size_t next = 0; next < cloud.size();) {
    // Never more than half full, so that runs of taken slots stay short.
    if (2 * (sums_.size() + kAhead) > slots_.size()) grow(std::max<std::size_t>(1024, 2 * slots_.size()));
    std::size_t count = 0;
    for (; count < kAhead && next < cloud.size(); ++next) {
      const auto voxel = voxel_of(cloud.points[next], voxel_m_);
      if (!voxel) {
        ++refused_;
        continue;
      }
      block[count] = {*voxel, home_of(*voxel), next};
      __builtin_prefetch(&slots_[block[count].home]);
      ++count;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [voxel, home, i] = block[k];
      const float intensity = cloud.has_intensities() ? cloud.intensities[i] : 0.0f;
      added += add_point(voxel, home, cloud.points[i], intensity) ? 1u : 0u;
    }
  }
  return added;
}

PointCloud VoxelMerger::cloud() const {
  PointCloud merged;
  merged.points.reserve(sums_.size());
  for (const Sum& sum : sums_) merged.points.emplace_back((sum.xyz / sum.count).cast<float>());
  if (!all_intensities_) return merged;
  merged.intensities.reserve(sums_.size());
  for (const Sum& sum : sums_) merged.intensities.push_back(static_cast<float>(sum.intensity / sum.count));
  return merged;
}

PointCloud voxel_downsample(const PointCloud& cloud, float voxel_m) {
  VoxelMerger merger(voxel_m, VoxelPoint::centroid);
  merger.add(cloud);
  return merger.cloud();
}

}  // namespace fleetmap::cloud
