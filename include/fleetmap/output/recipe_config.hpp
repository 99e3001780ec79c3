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
};

}  // namespace fleetmap::output
