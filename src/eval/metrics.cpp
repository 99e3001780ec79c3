#include "fleetmap/eval/metrics.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>

#include "fit_to_truth.hpp"
#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/eval/density.hpp"
#include "thinning.hpp"
#include "truth_surface.hpp"

namespace fleetmap::eval {
namespace {

constexpr std::size_t kTargetPoints = 300'000;
constexpr std::size_t kSourcePoints = 30'000;
constexpr std::size_t kDensityBins = 40;
constexpr std::size_t kMinInliers = 50;

/// Point-to-plane ICP from where the georeferences put the map.
Pose registered(const cloud::PointCloud& map, const TruthSurface& truth, const MapMetricsConfig& config) {
  const cloud::PointCloud target = thinned_to(truth.cloud(), 0.2, kTargetPoints);
  const cloud::KdTree tree(target);
  std::vector<std::size_t> in_truth;
  in_truth.reserve(target.size());
  for (const Eigen::Vector3f& p : target.points) in_truth.push_back(truth.tree().nearest(p, 1.0f)->index);
  const std::vector<Eigen::Vector3f> normals = truth.normals_at(in_truth);
  // The points are shuffled so that neither of two layers of a wrong map is preferred.
  const cloud::PointCloud source = thinned_to(shuffled(map), 0.3, kSourcePoints);
  const auto first = static_cast<float>(config.registration_distance);
  const auto last = static_cast<float>(config.inlier_distance);
  return fit_to_truth({target.points, normals, tree}, source.points,
                      std::array{std::max(first, last), std::max(0.5f * first, last), last});
}

/// Fisher information of the registration: each inlier measures the map's pose along the truth's normal.
void set_covariance(MapMetrics& metrics, const std::vector<Eigen::Vector3f>& map,
                    const std::vector<Foot>& feet, const TruthSurface& truth, double min_noise) {
  Matrix6d information = Matrix6d::Zero();
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    if (!feet[i].found || feet[i].normal.isZero()) continue;
    const Eigen::Vector3d p = map[i].cast<double>();
    const Eigen::Vector3d n = feet[i].normal.cast<double>();
    const double r = n.dot(p - truth.cloud().points[feet[i].truth].cast<double>());
    Vector6d J;
    J << n, p.cross(n);
    information.selfadjointView<Eigen::Lower>().rankUpdate(J);
    squares += r * r;
    ++count;
  }
  if (count == 0) {
    metrics.det_covariance = std::numeric_limits<double>::infinity();
    return;
  }
  metrics.sigma = std::max(min_noise, std::sqrt(squares / static_cast<double>(count)));
  information = Matrix6d(information.selfadjointView<Eigen::Lower>()) / (metrics.sigma * metrics.sigma);
  // det C = 1 / det I does not depend on the point about which rotations are taken.
  metrics.det_covariance = 1.0 / information.determinant();
}

void set_density(MapMetrics& metrics, const std::vector<Eigen::Vector3f>& map,
                 const MapMetricsConfig& config) {
  const std::vector<Eigen::Vector3f> queries = evenly(map, config.max_densities);
  const auto counts = density_at(queries, map, static_cast<float>(config.density_radius));
  const double largest = *std::max_element(counts.begin(), counts.end());
  // Bins of 1, 2 or 5 times a power of ten, so that those of two maps can be laid over each other.
  const double wanted = std::max(1.0, largest / static_cast<double>(kDensityBins));
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  metrics.density_bin = power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= wanted) metrics.density_bin = factor * power;
  }
  if (metrics.density_bin < wanted) metrics.density_bin = 10.0 * power;
  metrics.density_histogram.assign(static_cast<std::size_t>(largest / metrics.density_bin) + 1, 0.0);
  const double share = 1.0 / static_cast<double>(counts.size());
  for (const std::uint32_t count : counts) {
    metrics.mean_density += share * count;
    metrics.density_histogram[static_cast<std::size_t>(count / metrics.density_bin)] += share;
  }
}

double harmonic(double a, double b) { return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0; }

/// From the map to the truth: Eq. 2, accuracy. Returns the mean distance, capped.
double set_accuracy(MapMetrics& metrics, const std::vector<Foot>& feet, const MapMetricsConfig& config) {
  double squares = 0.0, point_squares = 0.0, sum = 0.0;
  std::size_t inliers = 0;
  std::array<std::size_t, 3> within{};
  for (const Foot& foot : feet) {
    if (!foot.found) {
      sum += config.inlier_distance;
      continue;
    }
    const double d = static_cast<double>(foot.surface_distance);
    ++inliers;
    squares += d * d;
    point_squares += std::pow(static_cast<double>(foot.point_distance), 2);
    sum += d;
    for (std::size_t k = 0; k < within.size(); ++k) within[k] += d <= config.thresholds[k] ? 1u : 0u;
  }
  const auto count = static_cast<double>(feet.size());
  metrics.inliers = static_cast<double>(inliers) / count;
  metrics.rmse = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, inliers)));
  metrics.rmse_points = std::sqrt(point_squares / static_cast<double>(std::max<std::size_t>(1, inliers)));
  for (std::size_t k = 0; k < within.size(); ++k)
    metrics.accuracy[k] = static_cast<double>(within[k]) / count;
  return sum / count;
}

/// From the truth to the map: Eq. 3, completeness. Returns the mean distance, capped.
double set_completeness(MapMetrics& metrics, const cloud::PointCloud& map,
                        const std::vector<Eigen::Vector3f>& truth, const MapMetricsConfig& config) {
  const cloud::KdTree tree(map);
  const auto farthest = static_cast<float>(std::max(config.truth_reach, config.inlier_distance));
  double sum = 0.0;
  std::size_t matched = 0, reached = 0;
  std::array<std::size_t, 3> within{};
  for (const Eigen::Vector3f& p : truth) {
    const auto nearest = tree.nearest(p, farthest);
    const double d = nearest ? std::sqrt(static_cast<double>(nearest->squared_distance)) : HUGE_VAL;
    sum += std::min(d, config.inlier_distance);
    matched += d <= config.inlier_distance ? 1u : 0u;
    reached += d <= config.truth_reach ? 1u : 0u;
    for (std::size_t k = 0; k < within.size(); ++k) within[k] += d <= config.thresholds[k] ? 1u : 0u;
  }
  const auto count = static_cast<double>(truth.size());
  metrics.fitness = static_cast<double>(matched) / count;
  metrics.reach = static_cast<double>(reached) / count;
  for (std::size_t k = 0; k < within.size(); ++k) {
    metrics.completeness[k] = static_cast<double>(within[k]) / count;
    metrics.completeness_in_reach[k] =
        static_cast<double>(within[k]) / static_cast<double>(std::max<std::size_t>(1, reached));
    metrics.f1[k] = harmonic(metrics.accuracy[k], metrics.completeness[k]);
    metrics.f1_in_reach[k] = harmonic(metrics.accuracy[k], metrics.completeness_in_reach[k]);
  }
  return sum / count;
}

double area_of(const std::vector<Eigen::Vector3f>& points) {
  std::unordered_set<std::uint64_t> cells;
  for (const Eigen::Vector3f& p : points) {
    const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.x())));
    const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.y())));
    cells.insert((std::uint64_t{x} << 32) | y);
  }
  return static_cast<double>(cells.size());
}

}  // namespace

namespace {

/// `T_truth_map` is known, or where the registration starts.
Result<EvaluatedMap> evaluated_points(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                      const Pose& T_truth_map, bool known, const MapMetricsConfig& config) {
  if (!all_finite(T_truth_map)) return failure("T_truth_map must be finite");
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  // Near its middle a map's coordinates are small, and turning it does not move it.
  const Eigen::Vector3f middle = middle_of(map);
  cloud::PointCloud thin = thinned({usable(map, middle), {}}, config.resolution);
  cloud::PointCloud truth_points =
      thinned({evenly(usable(truth, middle), config.max_truth), {}}, config.resolution);
  if (thin.empty()) return failure("the map holds no finite point");
  if (truth_points.empty()) return failure("the truth holds no finite point");
  sort_by_place(thin.points);
  sort_by_place(truth_points.points);
  const TruthSurface surface(std::move(truth_points));
  const Eigen::Translation3d to_middle(middle.cast<double>());
  Pose T = to_middle.inverse() * T_truth_map * to_middle;
  if (!known) T = registered(cloud::transformed(thin, T), surface, config) * T;
  const cloud::PointCloud placed = cloud::transformed(thin, T);
  const std::vector<Eigen::Vector3f> sampled = evenly(placed.points, config.max_distances);
  const auto feet = surface.feet_of(sampled, static_cast<float>(config.inlier_distance));
  const auto inliers = std::count_if(feet.begin(), feet.end(), [](const Foot& foot) { return foot.found; });
  if (static_cast<std::size_t>(inliers) < std::min(kMinInliers, sampled.size())) {
    return failure("the map and the truth do not overlap: " + std::to_string(inliers) + " of " +
                   std::to_string(sampled.size()) +
                   " points have truth nearby; are both in ENU of the same origin?");
  }
  EvaluatedMap evaluated;
  MapMetrics& metrics = evaluated.metrics;
  metrics = describe_map(map, config);
  metrics.T_truth_map = to_middle * T * to_middle.inverse();
  const double there = set_accuracy(metrics, feet, config);
  const double back =
      set_completeness(metrics, placed, evenly(surface.cloud().points, config.max_distances), config);
  metrics.chamfer = 0.5 * (there + back);
  set_covariance(metrics, sampled, feet, surface, config.min_noise);
  // Each point taken stands for as many as were left out.
  metrics.det_covariance *=
      std::pow(static_cast<double>(sampled.size()) / static_cast<double>(placed.size()), 6.0);
  metrics.truth_spacing = static_cast<double>(surface.spacing());
  metrics.truth_points = surface.cloud().size();
  for (std::size_t i = 0; i < feet.size(); ++i) {
    evaluated.points.points.push_back(sampled[i] + middle);
    evaluated.errors.push_back(feet[i].found ? feet[i].surface_distance
                                             : static_cast<float>(config.inlier_distance));
  }
  return evaluated;
}

}  // namespace

Result<EvaluatedMap> evaluate_map_points(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                         const MapMetricsConfig& config, const Pose& T_truth_map) {
  return evaluated_points(map, truth, T_truth_map, false, config);
}

Result<MapMetrics> evaluate_registered_map(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                           const Pose& T_truth_map, const MapMetricsConfig& config) {
  const auto evaluated = evaluated_points(map, truth, T_truth_map, true, config);
  if (!evaluated) return tl::unexpected(evaluated.error());
  return evaluated->metrics;
}

Result<MapMetrics> evaluate_map(const cloud::PointCloud& map, const cloud::PointCloud& truth,
                                const MapMetricsConfig& config) {
  const auto evaluated = evaluate_map_points(map, truth, config);
  if (!evaluated) return tl::unexpected(evaluated.error());
  return evaluated->metrics;
}

MapMetrics describe_map(const cloud::PointCloud& map, const MapMetricsConfig& config) {
  MapMetrics metrics;
  metrics.map_points = map.size();
  const std::vector<Eigen::Vector3f> points = usable(map, Eigen::Vector3f::Zero());
  if (points.empty()) return metrics;
  set_density(metrics, points, config);
  metrics.mapped_area = area_of(points);
  return metrics;
}

double mapped_area(const cloud::PointCloud& map) { return area_of(usable(map, Eigen::Vector3f::Zero())); }

std::vector<float> errors_of(const cloud::PointCloud& map, const cloud::PointCloud& truth, double cap) {
  std::vector<float> errors(map.size(), static_cast<float>(cap));
  cloud::PointCloud points{usable(truth, Eigen::Vector3f::Zero()), {}};
  if (points.empty() || map.empty()) return errors;
  const TruthSurface surface(thinned(points, MapMetricsConfig{}.resolution));
  const auto feet = surface.feet_of(map.points, static_cast<float>(cap));
  for (std::size_t i = 0; i < feet.size(); ++i) {
    if (feet[i].found) errors[i] = feet[i].surface_distance;
  }
  return errors;
}

}  // namespace fleetmap::eval
