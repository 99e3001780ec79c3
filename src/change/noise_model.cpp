#include "noise_model.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::change {
namespace {

constexpr std::size_t kMinDistances = 100;  // in a tile, for a quantile of a hundredth
constexpr double kNoiseShare = 0.99;
/// Changed surfaces can be most of a tile, so the fit of two days is read from the quarter that fits best.
constexpr double kFitShare = 0.25;

std::optional<float> quantile_of(std::vector<float>& values, double share) {
  if (values.size() < kMinDistances) return std::nullopt;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

void TileDistances::add(const CellMap& from, const CellMap& to, const ChangeConfig& config) {
  const auto reach = static_cast<float>(config.reach_m);
  for (const CellMap::Cell& cell : from.cells()) {
    if (cell.submaps < config.min_submaps) continue;
    const float distance = to.distance(cell.centre, reach);
    distances_[tile_of(cell.centre)].push_back(distance);
    all_.push_back(distance);
  }
}

TileDistances::Tile TileDistances::tile_of(const Eigen::Vector3f& point) const {
  return {static_cast<int>(std::floor(point.x() / tile_m_)),
          static_cast<int>(std::floor(point.y() / tile_m_))};
}

std::optional<float> TileDistances::quantile(const Tile& tile, double share) const {
  const auto found = distances_.find(tile);
  return found == distances_.end() ? std::nullopt : quantile_of(found->second, share);
}

std::optional<float> TileDistances::quantile(double share) const { return quantile_of(all_, share); }

float NoiseModel::min_distance(const Eigen::Vector3f& point) const {
  const TileDistances::Tile tile = within_.tile_of(point);
  const auto known = tiles_.find(tile);
  return known != tiles_.end() ? known->second : tiles_.emplace(tile, of_tile(tile)).first->second;
}

float NoiseModel::of_tile(const TileDistances::Tile& tile) const {
  const auto reach = static_cast<float>(config_.reach_m), cell = static_cast<float>(config_.cell_m);
  const auto noise = within_.quantile(tile, kNoiseShare);
  if (!noise) return reach;  // too little was seen there to tell noise from change
  float scale = 1.0f;
  if (between_ != nullptr) {
    const auto same = within_.quantile(tile, kFitShare), other = between_->quantile(tile, kFitShare);
    if (!same || !other) return reach;
    scale = std::max(1.0f, *other / std::max(*same, 0.05f * cell));
  }
  return std::clamp(*noise * scale, cell, reach);
}

}  // namespace fleetmap::change
