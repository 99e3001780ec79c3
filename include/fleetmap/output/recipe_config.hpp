#pragma once

#include <optional>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/placement_config.hpp"
#include "fleetmap/store/merge_config.hpp"

namespace fleetmap::output {

/// Origin, placement and merging of an agent's map.
struct RecipeConfig {
  std::optional<GeoPoint> site_origin;  ///< of ENU; absent: site_origin() of the store
  graph::PlacementConfig placement;
  store::MergeConfig map;
  double search_radius_m = 30.0;  ///< m, r_max of Eq. 1: nodes further apart are not registered
};

}  // namespace fleetmap::output
