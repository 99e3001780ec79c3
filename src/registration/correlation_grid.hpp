#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "correlation_grid_config.hpp"

namespace fleetmap::registration {

inline constexpr int kLayers = 8;  ///< the last holds all that is higher

/// Heights of the floor on a grid.
struct Floor {
  float cell_m = 2.0f;
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();
  Eigen::Vector2i size = Eigen::Vector2i::Zero();
  std::vector<float> heights;  ///< NaN where nothing was observed
  /// NaN where it is unknown.
  float at(const Eigen::Vector2f& p) const;
};

/// An occupied cell of the moving cloud.
struct CorrelationCell {
  Eigen::Vector2f center;
  int layer = 0;
};

/// A levelled cloud from above: the occupied cells by height above the floor. The floor is the lower
/// envelope of the points, so two clouds agree on heights before their offset in height or their common tilt
/// is estimated.
struct CorrelationGrid {
  float cell_m = 0.6f;
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();
  Eigen::Vector2i size = Eigen::Vector2i::Zero();
  /// Layer by layer, row by row: 2 where occupied, 1 next to that.
  std::vector<std::uint8_t> layers;
  /// Grid of kObservedCells x kObservedCells cells: 1 where there is any point, floor or not.
  Eigen::Vector2i observed_size = Eigen::Vector2i::Zero();
  std::vector<std::uint8_t> observed;
  std::vector<CorrelationCell> cells;  ///< picked
  Floor floor;
};

inline constexpr int kObservedCells = 4;

/// `points` are levelled (z against gravity).
CorrelationGrid correlation_grid(const std::vector<Eigen::Vector3f>& points,
                                 const CorrelationGridConfig& config);

}  // namespace fleetmap::registration
