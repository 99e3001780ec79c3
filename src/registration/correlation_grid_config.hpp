#pragma once

#include <cstddef>

namespace fleetmap::registration {

/// Configuration of CorrelationGrid.
struct CorrelationGridConfig {
  float cell_m = 0.6f;          ///< m
  float layer_m = 0.6f;         ///< m of height above the floor
  float floor_cell_m = 2.0f;    ///< m
  float min_height_m = 0.35f;   ///< m above the floor, what is lower is floor
  std::size_t max_cells = 600;  ///< of a cloud that moves: those compared, evenly picked
};

}  // namespace fleetmap::registration
