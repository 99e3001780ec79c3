#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Parameters of the statistical outlier removal (Rusu et al. 2008).
struct OutlierConfig {
  static constexpr std::size_t kMaxNeighbors = 63;
  std::size_t neighbors = 10;  ///< nearest points, without the point itself, at most 63
  double sigmas = 2.0;  ///< a point goes when its mean distance exceeds mean + sigmas * standard deviation
  Status validate() const;
};

}  // namespace fleetmap::cloud
