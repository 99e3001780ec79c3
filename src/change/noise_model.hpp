#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cell_map.hpp"
#include "fleetmap/change/change_config.hpp"

namespace fleetmap::change {

/// Distances of surfaces seen twice, by tile. One tile is a square of the map's xy plane.
class TileDistances {
 public:
  using Tile = std::pair<int, int>;

  explicit TileDistances(double tile_m) : tile_m_(tile_m) {}
  /// Adds the distances from the cells of `from`, that several submaps saw, to `to`.
  void add(const CellMap& from, const CellMap& to, const ChangeConfig& config);
  Tile tile_of(const Eigen::Vector3f& point) const;
  /// Empty where too few distances lie in the tile.
  std::optional<float> quantile(const Tile& tile, double share) const;
  std::optional<float> quantile(double share) const;  ///< of all tiles

 private:
  double tile_m_;
  mutable std::map<Tile, std::vector<float>> distances_;
  mutable std::vector<float> all_;
};

/// From what distance on surfaces differ.
class NoiseModel {
 public:
  /// `within`: between halves of one day, which the world's changes do not enter. `between`: the two days, of
  /// which changed surfaces are a part; none for a comparison within one day.
  NoiseModel(const TileDistances& within, const TileDistances* between, const ChangeConfig& config)
      : within_(within), between_(between), config_(config) {}
  /// m; at least a cell, at most ChangeConfig::reach_m.
  float min_distance(const Eigen::Vector3f& point) const;

 private:
  float of_tile(const TileDistances::Tile& tile) const;

  const TileDistances& within_;
  const TileDistances* between_;
  const ChangeConfig& config_;
  mutable std::map<TileDistances::Tile, float> tiles_;  ///< computed so far
};

}  // namespace fleetmap::change
