#pragma once

#include <array>
#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::eval {

/// Distances and sizes of the comparison of a map with the truth.
struct MapMetricsConfig {
  double inlier_distance = 0.5;                        ///< m, of Eq. 2 and Eq. 3
  double density_radius = 1.0;                         ///< m, r_d of Eq. 4
  std::array<double, 3> thresholds{0.05, 0.10, 0.20};  ///< m, of accuracy, completeness and F1
  /// m: truth farther than this from every point of the map counts as out of the LiDARs' reach.
  double truth_reach = 1.0;
  double resolution = 0.05;            ///< m: of each cloud the first point of each voxel of this edge counts
  double registration_distance = 3.0;  ///< m, of the first correspondences of the registration
  double min_noise = 0.005;            ///< m, floor of sigma in det(C)
  std::size_t max_truth = 10'000'000;  ///< points of the truth that are kept, evenly chosen
  std::size_t max_distances = 500'000;  ///< points of each cloud whose distance is taken, evenly chosen
  std::size_t max_densities = 200'000;  ///< points of the map whose density is taken, evenly chosen
  Status validate() const;
};

}  // namespace fleetmap::eval
