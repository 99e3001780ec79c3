#pragma once

#include <cstddef>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

struct OutlierConfig {
  std::size_t neighbors = 10;  ///< nearest points, without the point itself, at most 63
  double sigmas = 2.0;  ///< a point goes when its mean distance exceeds mean + sigmas * standard deviation
  Status validate() const;
};

struct OutlierSplit {
  std::vector<std::size_t> kept;     ///< ascending
  std::vector<std::size_t> removed;  ///< ascending; non-finite points are among them
};

/// Statistical outlier removal: points whose mean distance to their nearest neighbours is unusual in the
/// whole cloud.
OutlierSplit split_outliers(const PointCloud& cloud, const OutlierConfig& config);

}  // namespace fleetmap::cloud
