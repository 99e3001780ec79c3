#include "fleetmap/planning/routes/route_planner_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = RoutePlannerConfig;

TEST(RoutePlannerConfig, LengthsLieInTheirRanges) {
  struct Range {
    double Config::*value;
    double low, high;
    const char* name;
  };
  for (const Range& range : {Range{&Config::clearance, 0.0, 20.0, "clearance"},
                             {&Config::cell, 0.05, 5.0, "cell"},
                             {&Config::snap, 0.0, 100.0, "snap"},
                             {&Config::margin, 0.0, 1000.0, "margin"}}) {
    expect_accepted(Config{}, range.value, {range.low, range.high});
    expect_refused(Config{}, range.value, {range.low - 0.01, range.high + 0.01, kNaN<double>}, range.name);
  }
}

}  // namespace
}  // namespace fleetmap::planning
