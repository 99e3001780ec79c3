#include "fleetmap/cloud/voxel_grid.hpp"

#include <bit>
#include <cmath>

namespace fleetmap::cloud {
namespace {

constexpr double kLargestCell = 9007199254740992.0;  // 2^53: beyond it neighbouring cells are one double

std::uint64_t mix(std::uint64_t h) {
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93u;
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

std::uint64_t hash_of(const std::array<std::int64_t, 3>& key) {
  return mix(static_cast<std::uint64_t>(key[0]) * 0x9e3779b97f4a7c15u +
             static_cast<std::uint64_t>(key[1]) * 0xc2b2ae3d27d4eb4fu +
             static_cast<std::uint64_t>(key[2]) * 0x165667b19e3779f9u);
}

std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }

/// Written out: the array's own comparison is a call of memcmp.
bool same(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

VoxelMerger::VoxelMerger(float voxel_m, VoxelPoint keep)
    : voxel_m_(std::isfinite(voxel_m) && voxel_m > 0.0f ? static_cast<double>(voxel_m) : 0.0), keep_(keep) {}

std::size_t VoxelMerger::slot_of(const Key& key, std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  const std::uint32_t tag = tag_of(hash);
  std::size_t slot = static_cast<std::size_t>(hash) & mask;
  while (slots_[slot].entry != 0 && !(slots_[slot].tag == tag && same(keys_[slots_[slot].entry - 1], key)))
    slot = (slot + 1) & mask;
  return slot;
}

void VoxelMerger::grow(std::size_t slots) {
  slots_.assign(std::bit_ceil(slots), {});
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::uint64_t hash = hash_of(keys_[i]);
    slots_[slot_of(keys_[i], hash)] = {static_cast<std::uint32_t>(i + 1), tag_of(hash)};
  }
}

bool VoxelMerger::add_point(const Eigen::Vector3f& point, float intensity) {
  const Eigen::Vector3d p = point.cast<double>();
  if (!p.allFinite()) {
    ++refused_;
    return false;
  }
  if (voxel_m_ == 0.0) {
    sums_.push_back({p, static_cast<double>(intensity), 1});
    return true;
  }
  const Eigen::Vector3d cell = (p / voxel_m_).array().floor();
  if (!(cell.cwiseAbs().maxCoeff() < kLargestCell)) {
    ++refused_;
    return false;
  }
  const Key key{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                static_cast<std::int64_t>(cell.z())};
  if (2 * (keys_.size() + 1) > slots_.size()) grow(std::max<std::size_t>(1024, 4 * (keys_.size() + 1)));
  const std::uint64_t hash = hash_of(key);
  const std::size_t slot = slot_of(key, hash);
  if (slots_[slot].entry == 0) {
    keys_.push_back(key);
    sums_.push_back({p, static_cast<double>(intensity), 1});
    slots_[slot] = {static_cast<std::uint32_t>(keys_.size()), tag_of(hash)};
    return true;
  }
  if (keep_ == VoxelPoint::centroid) {
    Sum& sum = sums_[slots_[slot].entry - 1];
    sum.xyz += p;
    sum.intensity += static_cast<double>(intensity);
    ++sum.count;
  }
  return false;
}

std::size_t VoxelMerger::add(const PointCloud& cloud) {
  if (cloud.empty()) return 0;
  all_intensities_ = all_intensities_ && cloud.has_intensities();
  std::size_t added = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    added += add_point(cloud.points[i], cloud.has_intensities() ? cloud.intensities[i] : 0.0f) ? 1u : 0u;
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
