#include "ray_evidence.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::change {
namespace {

/// Rays are followed from block to block, and by cells only where a block has any.
constexpr double kBlock = 2.0;   // m
constexpr float kStride = 1.0f;  // m, at most half a block

}  // namespace

RayEvidence::RayEvidence(const std::vector<Eigen::Vector3f>& points, double cell_m, float margin)
    : cell_m_(cell_m), margin_(margin), points_(points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto cell = cloud::voxel_of(points[k], cell_m);
    const auto block = cloud::voxel_of(points[k], kBlock);
    if (!cell || !block) continue;
    index_.emplace(*cell, static_cast<std::uint32_t>(k));
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) blocks_.insert({block->x + x, block->y + y, block->z + z});
      }
    }
  }
}

bool RayEvidence::near_cells(const Eigen::Vector3f& point) const {
  const auto block = cloud::voxel_of(point, kBlock);
  return block && blocks_.contains(*block);
}

template <class Visitor>
void RayEvidence::visit(const Eigen::Vector3f& from, const Eigen::Vector3f& to, Visitor visitor) const {
  const Eigen::Vector3f way = to - from;
  const float length = way.norm() - margin_;
  if (!(length > 0.0f)) return;
  const Eigen::Vector3f direction = way.normalized();
  const auto step = static_cast<float>(0.5 * cell_m_);
  for (float begin = 0.0f; begin < length; begin += kStride) {
    const float end = std::min(begin + kStride, length);
    if (!near_cells(from + 0.5f * (begin + end) * direction)) continue;
    for (float at = begin; at < end; at += step) {
      const auto cell = cloud::voxel_of(Eigen::Vector3f(from + at * direction), cell_m_);
      if (!cell) continue;
      if (const auto found = index_.find(*cell); found != index_.end()) visitor(found->second);
    }
  }
}

std::vector<std::uint32_t> RayEvidence::passes(const std::vector<const ObservedSubmap*>& submaps) const {
  std::vector<std::uint32_t> passes(points_.size(), 0), last(points_.size(), 0);
  std::uint32_t number = 0;
  for (const ObservedSubmap* submap : submaps) {
    ++number;
    const auto count = [&](std::uint32_t cell) {
      if (std::exchange(last[cell], number) != number) ++passes[cell];
    };
    for (const Eigen::Vector3f& point : submap->points.points) visit(submap->sensor, point, count);
  }
  return passes;
}

}  // namespace fleetmap::change
