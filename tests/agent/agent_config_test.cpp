#include "fleetmap/agent/agent_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::expect_refused;

AgentConfig valid() {
  AgentConfig config;
  config.id = AgentId::parse("r1").value();
  config.directory = "out";
  config.exchange.fleet = {config.id, AgentId::parse("r2").value()};
  return config;
}

TEST(AgentConfig, NameFolderAndFleetAreEnough) {
  const Status status = valid().validate();
  EXPECT_TRUE(status) << status.error().message;
  EXPECT_FALSE(valid().exchange.payload_size) << "the agent fills it in";
}

TEST(AgentConfig, EachOfThemIsNeeded) {
  expect_refused(
      valid(), [](AgentConfig& c) { c.id = {}; }, "id is missing");
  expect_refused(
      valid(), [](AgentConfig& c) { c.directory.clear(); }, "directory is missing");
  expect_refused(
      valid(), [](AgentConfig& c) { c.exchange.fleet.clear(); }, "exchange.fleet");
  expect_refused(
      valid(),
      [](AgentConfig& c) {
        c.site_origin = GeoPoint{9.0, 0.0, 0.0};
      },
      "site.origin");
}

TEST(AgentConfig, EachPartIsCheckedUnderItsName) {
  expect_refused(
      valid(), [](AgentConfig& c) { c.perception.waiting_scans = 0; }, "odometry.waiting_scans");
  expect_refused(
      valid(), [](AgentConfig& c) { c.perception.odometry.max_iterations = 0; }, "odometry: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.perception.localization.history = 0.0; }, "localization: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.nodes.spacing = 0.0; }, "nodes: spacing");
  expect_refused(
      valid(), [](AgentConfig& c) { c.own_path.reach = 0.0; }, "own_path.reach");
  expect_refused(
      valid(), [](AgentConfig& c) { c.loop_closure.max_attempts = 0; }, "exchange: loop_candidates");
  expect_refused(
      valid(), [](AgentConfig& c) { c.submap.voxel = 0.0; }, "submap: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.spherize.radius_m = 0.0f; }, "spherize: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.registration.voxel_m = 0.0f; }, "registration: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.exchange.status_period = {}; }, "exchange: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.store.max_submap_bytes = 0; }, "store: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.map.voxel_m = 0.0; }, "map: ");
  expect_refused(
      valid(), [](AgentConfig& c) { c.placement.fleet.window_m = 0.0; }, "fleet.window_m");
}

TEST(AgentConfig, PartsFitTogether) {
  // A cloud that is requested must be receivable.
  expect_refused(
      valid(), [](AgentConfig& c) { c.loop_closure.max_active = c.exchange.clouds.max_receiving + 1; },
      "max_active must be at most");
  // The clouds around the two nodes of a loop would share submaps.
  expect_refused(
      valid(), [](AgentConfig& c) { c.spherize.radius_m = static_cast<float>(0.51 * c.own_path.min_path); },
      "at least twice spherize.radius");
}

TEST(AgentConfig, ResultsAreMadeByTheSameRules) {
  AgentConfig config = valid();
  config.site_origin = GeoPoint{0.8, 0.1, 50.0};
  config.map.voxel_m = 0.3;
  config.loop_closure.proximity.max_radius = 21.0;
  config.placement.method = graph::PlacementMethod::paper;
  const output::ResultsConfig results = config.results();
  EXPECT_EQ(results.agent, config.id);
  EXPECT_EQ(results.directory, config.directory);
  ASSERT_TRUE(results.recipe.site_origin);
  EXPECT_EQ(results.recipe.site_origin->altitude, 50.0);
  EXPECT_EQ(results.recipe.map.voxel_m, 0.3);
  EXPECT_EQ(results.recipe.search_radius_m, 21.0);
  EXPECT_EQ(results.recipe.placement.method, graph::PlacementMethod::paper);
}

}  // namespace
}  // namespace fleetmap::agent
