#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::eval {

struct MapMetricsConfig {
  double inlier_distance = 0.5;                        ///< m, of Eq. 2 and Eq. 3
  double density_radius = 1.0;                         ///< m, r_d of Eq. 4
  std::array<double, 3> thresholds{0.05, 0.10, 0.20};  ///< m, of accuracy, completeness and F1
  double truth_reach =
      1.0;  ///< m: truth farther than this from any place the LiDARs could see is not asked for
  Status validate() const;
};

/// A merged map against the truth (paper, section 4, and what users of mapping know).
struct MapMetrics {
  Pose T_truth_map = Pose::Identity();    ///< that registers the map to the truth
  double rmse = 0.0;                      ///< m, Eq. 2: of inlier correspondences
  double fitness = 0.0;                   ///< Eq. 3: N_c / N_g
  double det_covariance = 0.0;            ///< det(C), C the inverse Fisher information of that registration
  double mean_density = 0.0;              ///< Eq. 4: points within r_d, mean over the map
  std::vector<double> density_histogram;  ///< share of points by number of neighbours
  double density_bin = 0.0;               ///< neighbours, width of a bin
  std::array<double, 3> accuracy{};       ///< share of map points within each threshold of the truth
  std::array<double, 3> completeness{};   ///< share of truth points within each threshold of the map
  std::array<double, 3> f1{};
  double chamfer = 0.0;  ///< m, mean of both directed mean distances (capped at inlier_distance)
  std::size_t map_points = 0;
  std::size_t truth_points = 0;
  double mapped_area = 0.0;  ///< m^2, ground covered by the map's points (1 m cells)
};

/// `map` and `truth` in the site's ENU frame. Fails when either is empty or they do not overlap.
Result<MapMetrics> evaluate_map(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                const MapMetricsConfig& config = {});

}  // namespace fleetmap::eval
