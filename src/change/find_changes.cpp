#include "fleetmap/change/find_changes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "cell_map.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "map_comparison.hpp"
#include "noise_model.hpp"

namespace fleetmap::change {
namespace {

using Submaps = std::vector<const ObservedSubmap*>;

Submaps every(std::span<const ObservedSubmap> submaps, std::size_t step, std::size_t first) {
  Submaps sampled;
  for (std::size_t k = first; k < submaps.size(); k += step) sampled.push_back(&submaps[k]);
  return sampled;
}

/// One point a cell is enough, for surfaces and for rays.
std::vector<ObservedSubmap> thinned(std::span<const ObservedSubmap> submaps, double cell_m) {
  std::vector<ObservedSubmap> thinned;
  thinned.reserve(submaps.size());
  for (const ObservedSubmap& submap : submaps)
    thinned.push_back({cloud::voxel_downsample(submap.points, static_cast<float>(cell_m)), submap.sensor});
  return thinned;
}

/// Two halves of a day.
struct Halves {
  Halves(const Submaps& first, const Submaps& second, double cell_m)
      : one(first, cell_m), other(second, cell_m) {}
  CellMap one, other;
};

/// Every second submap: both halves are seen from the same places, and differ by noise and leaves.
Halves alternating(std::span<const ObservedSubmap> day, double cell_m) {
  return {every(day, 2, 0), every(day, 2, 1), cell_m};
}

/// Earlier and later: seen from other places, with what moved in between.
Halves successive(std::span<const ObservedSubmap> day, double cell_m) {
  const std::size_t half = day.size() / 2;
  return {every(day.first(half), 1, 0), every(day.subspan(half), 1, 0), cell_m};
}

std::size_t largest_false_change(const Halves& halves, const TileDistances& within,
                                 const ChangeConfig& config) {
  const NoiseModel noise(within, nullptr, config);
  std::size_t largest = 0;
  for (const auto& [map, other] :
       {std::pair(&halves.one, &halves.other), std::pair(&halves.other, &halves.one)}) {
    const MapComparison compared = compare(*map, *other, noise, config);
    if (!compared.free.empty()) largest = std::max(largest, compared.free.front().traversed);
  }
  return largest;
}

Change change_of(Kind kind, const FreeCluster& cluster, double cell_m) {
  Change change;
  change.kind = kind;
  change.cells = cluster.points.size();
  change.traversed = cluster.traversed;
  change.points = cluster.points;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : cluster.points) mean += point.cast<double>();
  mean /= static_cast<double>(cluster.points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3f& point : cluster.points) {
    const Eigen::Vector2d d = point.cast<double>().head<2>() - mean.head<2>();
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<1, 2>() = along.transpose();
  R.block<1, 2>(1, 0) << -along.y(), along.x();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (const Eigen::Vector3f& point : cluster.points) {
    const Eigen::Vector3d p = R * (point.cast<double>() - mean);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  change.centre = mean + R.transpose() * (0.5 * (low + high));
  change.size = high - low + Eigen::Vector3d::Constant(cell_m);
  change.heading_rad = std::atan2(along.y(), along.x());
  return change;
}

void add(Kind kind, MapComparison&& compared, const ChangeConfig& config, Changes& result) {
  for (const FreeCluster& cluster : compared.free) {
    if (cluster.traversed < result.min_cells) continue;
    Change& change = result.changes.emplace_back(change_of(kind, cluster, config.cell_m));
    change.confidence =
        1.0 - static_cast<double>(result.min_cells - 1) / static_cast<double>(change.traversed);
  }
  result.compared += compared.same.size() + compared.traversed;
  result.unknown += compared.unobserved.size();
  if (kind == Kind::appeared) result.same = std::move(compared.same);
  result.unobserved.insert(result.unobserved.end(), compared.unobserved.begin(), compared.unobserved.end());
}

double median_min_distance(const NoiseModel& noise, const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> min_distances;
  for (const Eigen::Vector3f& point : points) min_distances.push_back(noise.min_distance(point));
  std::ranges::nth_element(min_distances,
                           min_distances.begin() + static_cast<std::ptrdiff_t>(min_distances.size() / 2));
  return min_distances[min_distances.size() / 2];
}

}  // namespace

const char* to_string(Kind kind) { return kind == Kind::appeared ? "appeared" : "disappeared"; }

Result<Changes> find_changes(std::span<const ObservedSubmap> all_before,
                             std::span<const ObservedSubmap> all_after, const ChangeConfig& config) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  const auto before = thinned(all_before, config.cell_m), after = thinned(all_after, config.cell_m);
  TileDistances within(config.tile_m), between(config.tile_m);
  Changes result;
  result.min_cells = config.min_cells;
  const Halves alternating_before = alternating(before, config.cell_m),
               alternating_after = alternating(after, config.cell_m);
  for (const Halves* halves : {&alternating_before, &alternating_after}) {
    within.add(halves->one, halves->other, config);
    within.add(halves->other, halves->one, config);
  }
  const Halves successive_before = successive(before, config.cell_m),
               successive_after = successive(after, config.cell_m);
  for (const Halves* halves :
       {&alternating_before, &alternating_after, &successive_before, &successive_after})
    result.min_cells = std::max(result.min_cells, largest_false_change(*halves, within, config) + 1);
  const CellMap map_before(every(before, 1, 0), config.cell_m), map_after(every(after, 1, 0), config.cell_m);
  between.add(map_before, map_after, config);
  between.add(map_after, map_before, config);
  const NoiseModel noise(within, &between, config);
  MapComparison gone = compare(map_before, map_after, noise, config);
  MapComparison come = compare(map_after, map_before, noise, config);
  if (come.same.empty() && gone.traversed + come.traversed == 0)
    return failure("no place was seen on both days, so that nothing can be compared");
  result.noise_m = within.quantile(0.5).value_or(0.0f);
  result.misfit_m = between.quantile(0.5).value_or(0.0f);
  result.min_distance_m = come.same.empty() ? config.reach_m : median_min_distance(noise, come.same);
  add(Kind::disappeared, std::move(gone), config, result);
  add(Kind::appeared, std::move(come), config, result);
  std::ranges::stable_sort(result.changes, std::greater{}, &Change::cells);
  return result;
}

}  // namespace fleetmap::change
