#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/map_metrics_config.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::eval {

/// A merged map against the truth (paper, section 4, and what users of mapping know).
///
/// The truth is a sample of surfaces: where it is flat around the truth point nearest to a map point, the map
/// point's distance is that to a disc of the truth's spacing around that point, else that to the point. So a
/// perfect map of a coarsely sampled truth has no error. Distances from the truth to the map are plain
/// distances to points: a sparse map is an incomplete map.
struct MapMetrics {
  Pose T_truth_map = Pose::Identity();  ///< that registers the map to the truth
  double rmse = 0.0;                    ///< m, Eq. 2: of inliers' distances to the truth's surface
  double rmse_points = 0.0;             ///< m, the same of plain distances to the nearest truth point
  double fitness = 0.0;                 ///< Eq. 3: N_c / N_g, truth points with a map point within
                                        ///< inlier_distance, over all truth points
  double inliers = 0.0;                 ///< share of map points within inlier_distance of the truth
  /// det(C) in m^3 rad^3, C = sigma^2 (sum J J^T)^-1 the inverse Fisher information of that registration
  /// over all inliers at `resolution`, each counted as one independent point-to-plane measurement.
  double det_covariance = 0.0;
  double sigma = 0.0;  ///< m, RMS of the inliers' point-to-plane residuals, at least `min_noise`
  /// Eq. 4: points of the map (as it is given) within r_d of a point of it, itself included; the mean.
  double mean_density = 0.0;
  std::vector<double> density_histogram;  ///< share of points by that number
  double density_bin = 0.0;               ///< points, width of a bin
  std::array<double, 3> accuracy{};       ///< share of map points within each threshold of the truth
  std::array<double, 3> completeness{};   ///< share of all truth points within each threshold of the map
  std::array<double, 3> f1{};             ///< harmonic mean of accuracy and completeness
  double reach = 0.0;                     ///< share of truth points within truth_reach of the map
  std::array<double, 3> completeness_in_reach{};  ///< completeness of those only
  std::array<double, 3> f1_in_reach{};
  double chamfer = 0.0;          ///< m, mean of both directed mean distances (capped at inlier_distance)
  double truth_spacing = 0.0;    ///< m, between neighbouring truth points, median
  std::size_t map_points = 0;    ///< as given
  std::size_t truth_points = 0;  ///< N_g, at `resolution` and at most `max_truth`
  double mapped_area = 0.0;      ///< m^2, ground covered by the map's points (1 m cells)
};

/// `map` and `truth` in the site's ENU frame, a few metres apart at most. Non-finite points are left out.
/// Fails when either is empty or they do not overlap.
Result<MapMetrics> evaluate_map(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                const MapMetricsConfig& config = {});

/// The same, and where the error is. The registration starts from `T_truth_map`: farther than a few metres
/// off a map of what repeats would be registered beside its place.
struct EvaluatedMap {
  MapMetrics metrics;
  cloud::PointCloud points;   ///< those of the map whose distance was taken, registered to the truth
  std::vector<float> errors;  ///< m, of each of them, at most inlier_distance
};
Result<EvaluatedMap> evaluate_map_points(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                         const MapMetricsConfig& config = {},
                                         const Pose& T_truth_map = Pose::Identity());

/// The same of a map whose registration to the truth is known already, such as a part of another map.
Result<MapMetrics> evaluate_registered_map(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                           const Pose& T_truth_map, const MapMetricsConfig& config = {});

/// Metrics that need no truth: density, area and number of points. The other fields stay 0.
MapMetrics describe_map(const cloud::PointCloud& map, const MapMetricsConfig& config = {});
/// MapMetrics::mapped_area alone.
double mapped_area(const cloud::PointCloud& map);

/// m, distance of each map point to the truth's surface as in MapMetrics, at most `cap`; `cap` for
/// non-finite points and where there is no truth. `map` must already be registered to the truth.
std::vector<float> errors_of(const cloud::PointCloud& map, const cloud::PointCloud& truth, double cap = 0.5);

}  // namespace fleetmap::eval
