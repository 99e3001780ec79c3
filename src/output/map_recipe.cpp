#include "fleetmap/output/map_recipe.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "search_radius.hpp"

namespace fleetmap::output {
namespace {

constexpr const char* kRecipeKey = "map_recipe";
using StoredRecipe = std::array<double, 13>;

}  // namespace

Status keep_recipe(store::Store& store, const RecipeConfig& config) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const GeoPoint origin = config.site_origin.value_or(GeoPoint{kUnknown, kUnknown, kUnknown});
  const graph::PlacementConfig& placement = config.placement;
  const StoredRecipe values{origin.latitude,
                            origin.longitude,
                            origin.altitude,
                            config.map.voxel_m,
                            config.map.centroids ? 1.0 : 0.0,
                            placement.method == graph::PlacementMethod::graph ? 1.0 : 0.0,
                            placement.paper.max_rmse,
                            placement.paper.gps_correlation_time,
                            placement.fleet.gps_correlation_time,
                            placement.fleet.gps_drift_share,
                            placement.fleet.window_m,
                            placement.fleet.alignment_floor_m,
                            placement.fleet.alignment_floor_rad};
  Bytes bytes(sizeof(values));
  std::memcpy(bytes.data(), values.data(), sizeof(values));
  if (const Status kept = store.set_meta(kRecipeKey, bytes); !kept) return kept;
  return keep_search_radius(store, config.search_radius_m);
}

std::optional<MapRecipe> map_recipe(const store::Store& store) {
  const auto stored = store.meta(kRecipeKey);
  StoredRecipe values{};
  if (!stored || !*stored || (*stored)->size() != sizeof(values)) return std::nullopt;
  std::memcpy(values.data(), (*stored)->data(), sizeof(values));
  MapRecipe recipe;
  const GeoPoint configured{values[0], values[1], values[2]};
  const auto origin = site_origin(store, std::isnan(values[0]) ? std::nullopt : std::optional(configured));
  if (!origin) return std::nullopt;
  recipe.origin = *origin;
  recipe.merge = {.voxel_m = values[3], .centroids = values[4] != 0.0};
  recipe.placement.method = values[5] != 0.0 ? graph::PlacementMethod::graph : graph::PlacementMethod::paper;
  recipe.placement.paper = {.max_rmse = values[6], .gps_correlation_time = values[7]};
  recipe.placement.fleet = {.gps_correlation_time = values[8],
                            .gps_drift_share = values[9],
                            .window_m = values[10],
                            .alignment_floor_m = values[11],
                            .alignment_floor_rad = values[12]};
  recipe.search_radius_m = search_radius(store).value_or(recipe.search_radius_m);
  if (!is_valid(recipe.origin) || !recipe.merge.validate() || !recipe.placement.validate())
    return std::nullopt;
  return recipe;
}

std::optional<MapRecipe> recipe_or_default(const store::Store& store, const std::optional<GeoPoint>& origin) {
  const std::optional<MapRecipe> kept = map_recipe(store);
  const auto found = origin || !kept ? site_origin(store, origin) : std::optional(kept->origin);
  if (!found) return std::nullopt;
  MapRecipe recipe = kept.value_or(MapRecipe{});
  recipe.origin = *found;
  return recipe;
}

}  // namespace fleetmap::output
