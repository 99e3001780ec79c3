#pragma once

#include <cstddef>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/store/tiled_merge.hpp"

namespace fleetmap::store {

/// A merged map that is thinned while its tiles come, so that it never holds many more than `max_points`
/// points: to draw it.
class ThinnedMap {
 public:
  /// `voxel_m` is that of the map; it grows by half as often as is needed.
  ThinnedMap(double voxel_m, std::size_t max_points);
  void add(const MapTile& tile);
  /// The map of all tiles that were added; `outline` is that of their merge.
  MergedMap map(const MapOutline& outline) const;
  double voxel_m() const { return static_cast<double>(voxel_m_); }

 private:
  float voxel_m_;
  std::size_t max_points_;
  cloud::VoxelMerger merger_;
  std::vector<std::uint8_t> observed_by_;
};

}  // namespace fleetmap::store
