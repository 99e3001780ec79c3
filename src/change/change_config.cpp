#include "fleetmap/change/change_config.hpp"

#include <cmath>

namespace fleetmap::change {

Status ChangeConfig::validate() const {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!positive(cell_m)) return failure("change.cell_m must be positive");
  if (!positive(tile_m) || tile_m < cell_m) return failure("change.tile_m must be at least cell_m");
  if (!positive(reach_m) || reach_m < cell_m) return failure("change.reach_m must be at least cell_m");
  if (min_submaps == 0) return failure("change.min_submaps must be positive");
  if (min_cells == 0) return failure("change.min_cells must be positive");
  return {};
}

}  // namespace fleetmap::change
