#pragma once

#include <cstdint>

#include "fleetmap/core/result.hpp"

namespace fleetmap::agent {

/// Thinning and encoding of the submap of a node (M_i of the paper).
struct SubmapConfig {
  double voxel = 0.1;                  ///< m, points are thinned to one a cube of this edge
  double resolution = 0.02;            ///< m, rounding of the encoded points
  double scan_spacing = 0.2;           ///< m of motion between scans that enter a submap
  double scan_angle = 0.1;             ///< rad of turn between scans that enter a submap
  std::uint32_t max_bytes = 4u << 20;  ///< of one encoded submap; thinned more coarsely until it fits
  Status validate() const;
};

}  // namespace fleetmap::agent
