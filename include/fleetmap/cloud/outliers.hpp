#pragma once

#include <cstddef>
#include <vector>

#include "fleetmap/cloud/outlier_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Indices of a cloud's points, divided into kept and removed ones.
struct OutlierSplit {
  std::vector<std::size_t> kept;     ///< ascending
  std::vector<std::size_t> removed;  ///< ascending; non-finite points are among them
};

/// Statistical outlier removal: points whose mean distance to their nearest neighbours is unusual in the
/// whole cloud.
OutlierSplit split_outliers(const PointCloud& cloud, const OutlierConfig& config);

}  // namespace fleetmap::cloud
