#include "fleetmap/planning/routes/route_planner_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(RoutePlannerConfig, LengthsLieInTheirRanges) {
  struct Range {
    double RoutePlannerConfig::*value;
    double low, high;
    const char* name;
  };
  for (const Range& range : {Range{&RoutePlannerConfig::clearance, 0.0, 20.0, "clearance"},
                             {&RoutePlannerConfig::cell, 0.05, 5.0, "cell"},
                             {&RoutePlannerConfig::snap, 0.0, 100.0, "snap"},
                             {&RoutePlannerConfig::margin, 0.0, 1000.0, "margin"}}) {
    expect_accepted(RoutePlannerConfig{}, range.value, {range.low, range.high});
    expect_refused(RoutePlannerConfig{}, range.value, {range.low - 0.01, range.high + 0.01, kNaN<double>},
                   range.name);
  }
}

}  // namespace
}  // namespace fleetmap::planning
