#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim {

/// The use of a table's slot.
enum class TableSlot : std::uint8_t { kTable, kEmpty, kCabin };

struct TreeFootprint {
  Eigen::Vector2d center;  ///< (u, v)
  double radius = 0.0;     ///< m
};

/// Positions of everything on a solar farm, in its own frame: u along the rows, v across, 0 in the middle.
struct SolarFarmLayout {
  Eigen::Vector2d direction;                   ///< ENU unit vector of u
  Eigen::Vector2d half_site;                   ///< m, the fence
  double depth = 0.0;                          ///< m, a table seen from above, across the row
  std::vector<double> rows;                    ///< v of each row's middle
  std::vector<double> tables;                  ///< u of the middle of each place in a row
  std::vector<bool> beside_road;               ///< of each place
  std::vector<std::vector<TableSlot>> places;  ///< [row][place]
  std::vector<TreeFootprint> trees;

  Eigen::Vector2d enu(const Eigen::Vector2d& uv) const {
    return {direction.x() * uv.x() - direction.y() * uv.y(), direction.y() * uv.x() + direction.x() * uv.y()};
  }
};

/// Horizontal size of the largest table, jitter of its tilt included.
double table_depth(const SolarFarmConfig& config);
Eigen::Vector2d cabin_size(const SolarFarmConfig& config);
int rows_that_fit(const SolarFarmConfig& config);
int tables_that_fit(const SolarFarmConfig& config);

SolarFarmLayout lay_out(const SolarFarmConfig& config);
/// As the farm was planned: with every table, without trees.
SiteDrawing drawing_of(const SolarFarmConfig& config, const SolarFarmLayout& layout);

}  // namespace fleetmap::sim
