#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fleetmap/sim/mesh.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// Square cells over a part of the plane, row by row from the south-west corner.
struct Grid {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  double cell = 0.25;  ///< m
  int columns = 0;
  int rows = 0;

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Height of the ground at each cell's centre (m): the lowest surface that is no wall, or what lies on it up
/// to a step high (boards, kerbs, the upper side of a thin slab). Cells without any take that of the nearest
/// ones that have some. `gap` counts the steps to those, saturated at 255: 0 where there is ground.
struct GroundRaster {
  std::vector<float> heights;
  std::vector<std::uint8_t> gap;
};
GroundRaster ground_raster(const Mesh& mesh, const Grid& grid, double step_height);

/// 1 for each cell that a robot cannot enter: an obstacle lies between the heights that it drives over and
/// its own, the ground is too steep, or there is no ground.
std::vector<std::uint8_t> obstacle_raster(const Mesh& mesh, const Grid& grid, const GroundRaster& ground,
                                          const DrivableConfig& config);

}  // namespace fleetmap::sim
