#pragma once

#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/drivable_config.hpp"
#include "fleetmap/sim/fence_config.hpp"
#include "fleetmap/sim/terrain_config.hpp"

namespace fleetmap::sim {

/// A photovoltaic power station: rows of tilted tables on posts, centred on the origin. The site is a
/// rectangle whose sides run along and across the rows; with the default azimuth those are east and north.
struct SolarFarmConfig {
  double size_east = 200.0;             ///< m along the rows, from fence to fence
  double size_north = 200.0;            ///< m across the rows
  double row_azimuth_rad = 1.57079633;  ///< rad, of the rows' direction, clockwise from north
  double margin = 15.0;                 ///< m of ground outside the fence
  double headland = 8.0;                ///< m free between the tables and the fence, on all sides

  double row_pitch = 7.0;          ///< m from row to row
  double table_length = 10.0;      ///< m along the row
  double table_width = 4.0;        ///< m up the slope
  double table_thickness = 0.04;   ///< m
  double table_gap = 0.4;          ///< m from table to table
  double tilt_rad = 0.436;         ///< rad (25 deg); the lower edge is to the right of the rows' direction
  double lower_edge_height = 0.8;  ///< m above the ground
  double post_spacing = 2.5;       ///< m along the row
  double post_radius = 0.06;       ///< m
  double missing_tables = 0.03;    ///< share of the places that are empty
  double tilt_jitter_rad = 0.01;   ///< rad, largest deviation of a table
  double height_jitter = 0.04;     ///< m, largest deviation of a table
  int road_every = 8;              ///< tables between two roads across the rows; 0: no such roads
  double road_width = 6.0;         ///< m

  int cabins = 2;  ///< inverter cabins, each in the place of a table next to a road or headland
  int trees = 20;  ///< outside the fence
  /// Trees in slots of tables, anywhere in the rows: with missing_tables 1 a wood with lanes.
  int trees_inside = 0;
  FenceConfig fence;
  TerrainConfig terrain;
  double terrain_cell = 1.0;  ///< m, of the ground's triangles
  DrivableConfig drivable;
  std::uint64_t seed = 1;

  /// Each field by itself, and that at least two rows of one table fit into the site.
  Status validate() const;
};

}  // namespace fleetmap::sim
