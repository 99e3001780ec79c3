#pragma once

namespace fleetmap::registration {

/// Configuration of SurfelMap.
struct SurfelConfig {
  float voxel_m = 0.35f;     ///< m
  float noise_m = 0.03f;     ///< m, of a point, added to the spread
  float extended_m = 0.15f;  ///< m, a larger spread along an axis is extent, not uncertainty
  int min_points = 4;
  float sparse_voxel_m =
      1.75f;  ///< m, where points lie too wide apart for surfels of `voxel_m`: thinned ground
  float hidden_depth_m = 0.12f;  ///< m, how far the middle of a post may lie behind the side that was seen
};

}  // namespace fleetmap::registration
