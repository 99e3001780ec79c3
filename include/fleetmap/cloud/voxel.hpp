#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace fleetmap::cloud {

/// Index of a voxel: the floor of each coordinate in units of the voxel's edge.
struct Voxel {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const Voxel&) const = default;
};

/// The voxel of edge `voxel_m` (m, positive) that holds `point`. Empty where the point is not finite, or more
/// than 2^31 - 1 voxels from the origin. The one rule of all grids, so that they agree in bits.
inline std::optional<Voxel> voxel_of(const Eigen::Vector3f& point, double voxel_m) {
  constexpr double kLargestIndex = 2147483647.0;
  const Eigen::Array3d index = (point.cast<double>() / voxel_m).array().floor();
  // NaN compares false as well.
  if (!(index.abs() <= kLargestIndex).all()) return std::nullopt;
  return Voxel{static_cast<std::int32_t>(index.x()), static_cast<std::int32_t>(index.y()),
               static_cast<std::int32_t>(index.z())};
}

/// Every bit depends on every bit of the index, on every machine alike.
inline std::uint64_t hash_of(const Voxel& voxel) {
  std::uint64_t h = static_cast<std::uint64_t>(static_cast<std::uint32_t>(voxel.x)) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(static_cast<std::uint32_t>(voxel.y)) * 0xc2b2ae3d27d4eb4fu +
                    static_cast<std::uint64_t>(static_cast<std::uint32_t>(voxel.z)) * 0x165667b19e3779f9u;
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

}  // namespace fleetmap::cloud
