#include "elevation_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ground_filter.hpp"

namespace fleetmap::output {
namespace {

constexpr std::int64_t kMaxCells = 100'000'000;
constexpr double kMaxCoordinate = 1e8;          // m, beyond all projected coordinates
constexpr float kBelow = 0.1f, kAbove = 0.25f;  // m, band of the ground's points about the low quantile

}  // namespace

Status ElevationConfig::validate() const {
  if (!(cell_m >= 0.05 && cell_m <= 1000.0)) return failure("cell: must be from 0.05 to 1000 m");
  if (!(max_window_m > 0.0)) return failure("max_window: must be positive");
  if (!(slope >= 0.0)) return failure("slope: must not be negative");
  if (!(first_step_m > 0.0 && max_step_m >= first_step_m))
    return failure("first_step: must be positive and at most max_step");
  return {};
}

void ElevationGrid::Extremes::add(float z) {
  const std::size_t kept = std::min<std::size_t>(count, kKept);
  const auto insert = [&](std::array<float, kKept>& sorted, auto before) {
    std::size_t at = kept;
    while (at > 0 && before(z, sorted[at - 1])) --at;
    for (std::size_t k = std::min(kept, kKept - 1); k > at; --k) sorted[k] = sorted[k - 1];
    if (at < kKept) sorted[at] = z;
  };
  insert(low, std::less<>{});
  insert(high, std::greater<>{});
  ++count;
}

std::size_t ElevationGrid::Extremes::rank() const { return std::min<std::size_t>(count / 20, kKept - 1); }

std::uint64_t ElevationGrid::key_of(const Cell& cell) {
  return std::uint64_t{static_cast<std::uint32_t>(cell.x())} << 32 | static_cast<std::uint32_t>(cell.y());
}

ElevationGrid::Cell ElevationGrid::cell_of(const Eigen::Vector3d& point) const {
  return (point.head<2>() / config_.cell_m).array().floor().matrix().cast<int>();
}

std::size_t ElevationGrid::index_of(const Cell& cell) const {
  return static_cast<std::size_t>(max_.y() - cell.y()) * static_cast<std::size_t>(raster_.width) +
         static_cast<std::size_t>(cell.x() - min_.x());
}

void ElevationGrid::add(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > kMaxCoordinate) continue;
    const Cell cell = cell_of(point);
    min_ = min_.cwiseMin(cell);
    max_ = max_.cwiseMax(cell);
    cells_[key_of(cell)].add(static_cast<float>(point.z()));
  }
}

Status ElevationGrid::find_ground() {
  if (cells_.empty()) return failure("the map has no points");
  const std::int64_t width = std::int64_t{max_.x()} - min_.x() + 1;
  const std::int64_t height = std::int64_t{max_.y()} - min_.y() + 1;
  if (width > kMaxCells || height > kMaxCells || width * height > kMaxCells) {
    return failure("a raster of " + std::to_string(width) + " x " + std::to_string(height) +
                   " cells is too large (" + std::to_string(kMaxCells) + "); take larger cells (--cell)");
  }
  raster_.cell = config_.cell_m;
  raster_.width = static_cast<int>(width);
  raster_.height = static_cast<int>(height);
  raster_.west = min_.x() * config_.cell_m;
  raster_.north = (max_.y() + 1) * config_.cell_m;
  const auto size = static_cast<std::size_t>(width * height);
  lowest_.assign(size, std::numeric_limits<float>::quiet_NaN());
  raster_.surface = lowest_;
  for (const auto& [key, extremes] : cells_) {
    const Cell cell(static_cast<std::int32_t>(key >> 32), static_cast<std::int32_t>(key & 0xffffffffu));
    lowest_[index_of(cell)] = extremes.low[extremes.rank()];
    raster_.surface[index_of(cell)] = extremes.high[extremes.rank()];
  }
  cells_.clear();
  const std::vector<bool> ground = ground_cells(lowest_, raster_.width, config_);
  for (std::size_t k = 0; k < size; ++k) {
    if (!ground[k]) lowest_[k] = std::numeric_limits<float>::quiet_NaN();
  }
  sums_.assign(size, 0.0);
  counts_.assign(size, 0);
  return {};
}

void ElevationGrid::add_to_ground(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > kMaxCoordinate) continue;
    const Cell cell = cell_of(point);
    // The map may have changed since find_ground(): a submap became readable.
    if ((cell.array() < min_.array()).any() || (cell.array() > max_.array()).any()) continue;
    const std::size_t index = index_of(cell);
    const auto above = static_cast<float>(point.z()) - lowest_[index];
    if (!(above >= -kBelow && above <= kAbove)) continue;  // NaN, too
    sums_[index] += point.z();
    ++counts_[index];
  }
}

ElevationRaster ElevationGrid::take() {
  raster_.ground.assign(sums_.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    if (counts_[k] > 0) raster_.ground[k] = static_cast<float>(sums_[k] / counts_[k]);
  }
  return std::move(raster_);
}

}  // namespace fleetmap::output
