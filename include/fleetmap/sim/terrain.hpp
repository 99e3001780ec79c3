#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/terrain_config.hpp"

namespace fleetmap::sim {

/// A rolling and rough ground: gradient noise (Perlin 2002) of a seed, two octaves for each of both scales.
/// Smooth, and independent of the order of queries. Height 0 on average.
class Terrain {
 public:
  Terrain(const TerrainConfig& config, std::uint64_t seed) : config_(config), seed_(seed) {}
  double height(double x, double y) const;
  /// (dh/dx, dh/dy).
  Eigen::Vector2d gradient(double x, double y) const;

 private:
  TerrainConfig config_;
  std::uint64_t seed_;
};

}  // namespace fleetmap::sim
