#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Search for the finest voxels whose encoding fits a budget of bytes.
struct FitConfig {
  std::size_t max_bytes = 25'000;      ///< of the whole encoding (paper: 25 kB on the long-range link)
  float min_voxel_m = 0.05f;           ///< m, finest voxel tried
  float max_voxel_m = 20.0f;           ///< m, coarsest voxel tried
  double voxel_over_resolution = 6.0;  ///< the codec's resolution is the voxel's edge divided by this
  bool encode_intensities = false;
  int max_encodings = 8;  ///< bound on the search
  Status validate() const;
};

}  // namespace fleetmap::cloud
