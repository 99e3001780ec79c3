#include "fleetmap/sim/fence_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(FenceConfig, LengthsLieInTheirRanges) {
  struct Range {
    double FenceConfig::*value;
    double low, high;
    const char* name;
  };
  for (const Range& range : {Range{&FenceConfig::height, 0.5, 5.0, "height"},
                             {&FenceConfig::post_spacing, 1.0, 10.0, "post_spacing"},
                             {&FenceConfig::wire_spacing, 0.04, 1.0, "wire_spacing"},
                             {&FenceConfig::wire_width, 0.001, 0.05, "wire_width"}}) {
    expect_accepted(FenceConfig{}, range.value, {range.low, range.high});
    expect_refused(FenceConfig{}, range.value, {0.99 * range.low, 1.01 * range.high, kNaN<double>},
                   range.name);
  }
}

TEST(FenceConfig, APanelMayHaveNoWires) { expect_accepted(FenceConfig{}, &FenceConfig::wire_spacing, {0.0}); }

TEST(FenceConfig, WithoutAFenceItsLengthsDoNotMatter) {
  FenceConfig none;
  none.enabled = false;
  expect_accepted(none, &FenceConfig::height, {-1.0, kNaN<double>});
}

}  // namespace
}  // namespace fleetmap::sim
