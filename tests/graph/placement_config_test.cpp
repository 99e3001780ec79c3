#include "fleetmap/graph/placement_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::graph {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

TEST(PlacementConfig, TheFleetsGraphIsCheckedWhateverTheMethod) {
  for (const PlacementMethod method : {PlacementMethod::graph, PlacementMethod::paper}) {
    PlacementConfig config;
    config.method = method;
    expect_accepted(config, &PlacementConfig::method, {method});
    expect_refused(
        config, [](PlacementConfig& c) { c.fleet.window_m = 0.0; }, "fleet.window_m");
  }
}

TEST(PlacementConfig, MethodsHaveTheNamesOfTheConfiguration) {
  EXPECT_STREQ(to_string(PlacementMethod::graph), "graph");
  EXPECT_STREQ(to_string(PlacementMethod::paper), "paper");
}

}  // namespace
}  // namespace fleetmap::graph
