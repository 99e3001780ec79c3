#include "fleetmap/output/map_recipe.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "fleetmap/output/placed_store.hpp"
#include "store/agents.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using testing::kSelf;

const GeoPoint kConfiguredSite = geo_point_from_degrees(48.001, 11.0, 500.0);
const GeoPoint kNode = geo_point_from_degrees(48.0, 11.0, 500.0);
const GeoPoint kElsewhere = geo_point_from_degrees(-33.0, 151.0, 10.0);

class MapRecipeTest : public ::testing::Test {
 protected:
  void add_node(bool located) {
    graph::Node node;
    node.id = {kSelf, store_.next_node_seq(0)};
    node.stamp = stamp_from_ns(1'000'000'000 * (node.id.seq + 1));
    if (located) {
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = kNode;
    }
    ASSERT_EQ(store_.put_node(node).value(), store::Put::kAdded);
  }

  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", kSelf).value());
};

TEST_F(MapRecipeTest, EverySettingIsKept) {
  RecipeConfig config;
  config.site_origin = kConfiguredSite;
  config.placement.method = graph::PlacementMethod::paper;
  config.placement.paper = {.max_rmse = 0.31, .gps_correlation_time = 32.0};
  config.placement.fleet = {.gps_correlation_time = 33.0,
                            .gps_drift_share = 0.34,
                            .window_m = 35.0,
                            .alignment_floor_m = 0.36,
                            .alignment_floor_rad = 0.037};
  config.map = {.voxel_m = 0.38, .centroids = !store::MergeConfig{}.centroids};
  config.search_radius_m = 39.0;
  ASSERT_TRUE(keep_recipe(store_, config));
  const auto recipe = map_recipe(store_);
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->origin, kConfiguredSite);
  EXPECT_EQ(recipe->merge.voxel_m, 0.38);
  EXPECT_EQ(recipe->search_radius_m, 39.0);
  EXPECT_EQ(recipe->merge.centroids, config.map.centroids);
  EXPECT_EQ(recipe->placement.method, graph::PlacementMethod::paper);
  EXPECT_EQ(recipe->placement.paper.max_rmse, 0.31);
  EXPECT_EQ(recipe->placement.paper.gps_correlation_time, 32.0);
  EXPECT_EQ(recipe->placement.fleet.gps_correlation_time, 33.0);
  EXPECT_EQ(recipe->placement.fleet.gps_drift_share, 0.34);
  EXPECT_EQ(recipe->placement.fleet.window_m, 35.0);
  EXPECT_EQ(recipe->placement.fleet.alignment_floor_m, 0.36);
  EXPECT_EQ(recipe->placement.fleet.alignment_floor_rad, 0.037);
}

TEST_F(MapRecipeTest, WithoutAConfiguredOriginItFollowsTheNodes) {
  ASSERT_TRUE(keep_recipe(store_, {}));
  EXPECT_FALSE(map_recipe(store_));  // no node yet
  add_node(true);
  ASSERT_TRUE(map_recipe(store_));
  EXPECT_EQ(map_recipe(store_)->origin, kNode);
}

TEST_F(MapRecipeTest, DamagedSettingsAreNoRecipe) {
  RecipeConfig config;
  config.site_origin = kConfiguredSite;
  ASSERT_TRUE(keep_recipe(store_, config));
  const Bytes whole = store_.meta("map_recipe").value().value();
  const auto with_value = [&](std::size_t index, double value) {
    Bytes bytes = whole;
    std::memcpy(bytes.data() + index * sizeof(double), &value, sizeof(double));
    return bytes;
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Bytes& wrong : {Bytes{}, Bytes(whole.begin(), whole.end() - 1), with_value(0, 9.0),
                             with_value(3, -1.0), with_value(3, kNaN), with_value(10, kNaN)}) {
    ASSERT_TRUE(store_.set_meta("map_recipe", wrong));
    EXPECT_FALSE(map_recipe(store_));
  }
  ASSERT_TRUE(store_.set_meta("map_recipe", whole));
  EXPECT_TRUE(map_recipe(store_));
}

TEST_F(MapRecipeTest, AStoreWithoutARecipeIsShownWithTheDefaults) {
  EXPECT_FALSE(recipe_or_default(store_));
  ASSERT_TRUE(recipe_or_default(store_, kElsewhere));
  EXPECT_EQ(recipe_or_default(store_, kElsewhere)->origin, kElsewhere);
  add_node(false);
  EXPECT_EQ(recipe_or_default(store_)->origin, GeoPoint{});
  add_node(true);
  const auto recipe = recipe_or_default(store_);
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->origin, kNode);
  EXPECT_EQ(recipe->merge.voxel_m, store::MergeConfig{}.voxel_m);
}

TEST_F(MapRecipeTest, AGivenOriginTakesTheRecipesPlaceButNotItsSettings) {
  RecipeConfig config;
  config.site_origin = kConfiguredSite;
  config.map.voxel_m = 0.25;
  ASSERT_TRUE(keep_recipe(store_, config));
  add_node(true);
  EXPECT_EQ(recipe_or_default(store_)->origin, kConfiguredSite);
  const auto moved = recipe_or_default(store_, kElsewhere);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->origin, kElsewhere);
  EXPECT_EQ(moved->merge.voxel_m, 0.25);
}

}  // namespace
}  // namespace fleetmap::output
