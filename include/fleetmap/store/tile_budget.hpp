#pragma once

#include <cstddef>

namespace fleetmap::store {

/// Bounds of the memory of a merge. The order of the points depends on them, so robots whose maps must be
/// equal byte for byte use the same.
struct TileBudget {
  std::size_t tile_voxels = 2'000'000;               ///< most points of a tile
  std::size_t cache_bytes = std::size_t{128} << 20;  ///< of points that later tiles need
  std::size_t sample_voxels = std::size_t{1} << 18;  ///< by which tiles are planned
};

}  // namespace fleetmap::store
