#include "fleetmap/agent/live_placement_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(LivePlacementConfig, DefaultsAreValid) { EXPECT_TRUE(LivePlacementConfig{}.validate()); }

TEST(LivePlacementConfig, TheShareIsOfOneCoreAndTimesArePositive) {
  expect_accepted(LivePlacementConfig{}, &LivePlacementConfig::cpu_share, {0.001, 1.0});
  expect_refused(LivePlacementConfig{}, &LivePlacementConfig::cpu_share, {0.0, -0.1, 1.1, kNaN<double>},
                 "live_cpu_share");
  expect_refused(LivePlacementConfig{}, &LivePlacementConfig::period, {Duration::zero(), Duration{-1}},
                 "period");
  expect_accepted(LivePlacementConfig{}, &LivePlacementConfig::cost_per_node, {Duration::zero()});
  expect_refused(LivePlacementConfig{}, &LivePlacementConfig::cost_per_node, {Duration{-1}}, "cost");
}

}  // namespace
}  // namespace fleetmap::agent
