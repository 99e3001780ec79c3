#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"

namespace fleetmap::change {

/// Resolution and evidence of find_changes(). The distance that counts as a difference is estimated from the
/// maps.
struct ChangeConfig {
  double cell_m = 0.2;   ///< m, edge of the cells that are compared
  double tile_m = 20.0;  ///< m, edge of the squares whose noise is estimated
  double reach_m = 3.0;  ///< m, surfaces farther apart than this are different ones, whatever the noise
  std::size_t min_submaps = 2;  ///< that must have seen a surface, and through a cell that is free
  std::size_t min_cells = 4;    ///< least size of a change; more where the noise makes larger ones
  Status validate() const;
};

}  // namespace fleetmap::change
