#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::output {

/// Rules by which a map becomes a raster of heights. The last four are those of Zhang et al. 2003
/// (ground_filter.hpp).
struct ElevationConfig {
  double cell_m = 0.5;         ///< m, edge of a cell
  double max_window_m = 32.0;  ///< m, widest opening: wider than any roof or table
  double slope = 0.15;         ///< rise over run of terrain that is kept
  double first_step_m = 0.2;   ///< m, height above the opened ground that is kept in the first window
  double max_step_m = 2.5;     ///< m, in the widest

  /// Names the field and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::output
