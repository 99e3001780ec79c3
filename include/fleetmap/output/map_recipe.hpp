#pragma once

#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/output/recipe_config.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Settings with which a map was made: `fleetmap map export` makes the same one again by them.
struct MapRecipe {
  GeoPoint origin;
  graph::PlacementConfig placement;
  store::MergeConfig merge;
  double search_radius_m =
      RecipeConfig{}.search_radius_m;  ///< m; also where an older program wrote the store
};

/// Stores how the agent's maps are made, so that what is made of the store later, whatever became of the
/// agent, is the same.
Status keep_recipe(store::Store& store, const RecipeConfig& config);
/// By the last keep_recipe(); where no origin was configured, with that of what the store holds now. Empty if
/// there was none, or there is no origin yet.
std::optional<MapRecipe> map_recipe(const store::Store& store);
/// Settings to show a store of which maybe no map was made: map_recipe(), else the defaults. The origin is
/// `origin`, else that of map_recipe(), else site_origin() of the store; empty if there is none of them.
std::optional<MapRecipe> recipe_or_default(const store::Store& store,
                                           const std::optional<GeoPoint>& origin = std::nullopt);

}  // namespace fleetmap::output
