#include "fleetmap/exchange/delay_window_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(DelayWindowConfig, TheTargetExceedsTheTicksOfBothEnds) {
  expect_accepted(DelayWindowConfig{}, &DelayWindowConfig::target_s, {DelayWindowConfig::kMinTarget, 10.0});
  expect_refused(DelayWindowConfig{}, &DelayWindowConfig::target_s,
                 {0.0, 0.049, kNaN<double>, kInfinity<double>}, "target_s");
}

TEST(DelayWindowConfig, StepLeastFirstAndMostDoNotDecrease) {
  DelayWindowConfig equal;
  equal.step_bytes = equal.min_bytes = equal.first_bytes = equal.max_bytes = 1000;
  EXPECT_TRUE(equal.validate());
  expect_refused(equal, &DelayWindowConfig::step_bytes, {0u, 1001u}, "step_bytes");
  expect_refused(equal, &DelayWindowConfig::min_bytes, {999u, 1001u}, "min_bytes");
  expect_refused(equal, &DelayWindowConfig::first_bytes, {999u, 1001u}, "first_bytes");
  expect_refused(equal, &DelayWindowConfig::max_bytes, {999u},
                 "short_range.window_bytes must be at least 1000");
}

}  // namespace
}  // namespace fleetmap::exchange
