#include "fleetmap/sim/fence_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = FenceConfig;

TEST(FenceConfig, LengthsLieInTheirRanges) {
  struct Range {
    double Config::*value;
    double low, high;
    const char* name;
  };
  for (const Range& range : {Range{&Config::height, 0.5, 5.0, "height"},
                             {&Config::post_spacing, 1.0, 10.0, "post_spacing"},
                             {&Config::wire_spacing, 0.04, 1.0, "wire_spacing"},
                             {&Config::wire_width, 0.001, 0.05, "wire_width"}}) {
    expect_accepted(Config{}, range.value, {range.low, range.high});
    expect_refused(Config{}, range.value, {0.99 * range.low, 1.01 * range.high, kNaN<double>}, range.name);
  }
}

TEST(FenceConfig, APanelMayHaveNoWires) { expect_accepted(Config{}, &Config::wire_spacing, {0.0}); }

TEST(FenceConfig, WithoutAFenceItsLengthsDoNotMatter) {
  Config none;
  none.enabled = false;
  expect_accepted(none, &Config::height, {-1.0, kNaN<double>});
}

}  // namespace
}  // namespace fleetmap::sim
