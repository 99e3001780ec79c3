#include "fleetmap/planning/mission/executive_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_not_negative;
using fleetmap::testing::expect_positive;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(ExecutiveConfig, DefaultsAreValid) { EXPECT_TRUE(ExecutiveConfig{}.validate()); }

TEST(ExecutiveConfig, TimesAreBounded) {
  expect_positive(ExecutiveConfig{}, {{&ExecutiveConfig::lost_after, "lost_after"},
                                      {&ExecutiveConfig::orphan_wait, "orphan_wait"},
                                      {&ExecutiveConfig::offer_period, "offer_period"},
                                      {&ExecutiveConfig::stuck_retry, "stuck_retry"},
                                      {&ExecutiveConfig::stop_patience, "stop_patience"},
                                      {&ExecutiveConfig::meeting_timeout, "meeting_timeout"}});
  expect_not_negative(ExecutiveConfig{},
                      {{&ExecutiveConfig::listen, "listen"}, {&ExecutiveConfig::offer_gain, "offer_gain"}});
}

TEST(ExecutiveConfig, BatteryAndCountsAreBounded) {
  expect_accepted(ExecutiveConfig{}, &ExecutiveConfig::low_battery, {0.0, 0.99});
  expect_refused(ExecutiveConfig{}, &ExecutiveConfig::low_battery, {-0.1, 1.0, kNaN<double>}, "low_battery");
  expect_accepted(ExecutiveConfig{}, &ExecutiveConfig::row_attempts, {1});
  expect_refused(ExecutiveConfig{}, &ExecutiveConfig::row_attempts, {0, -1}, "row_attempts");
  expect_accepted(ExecutiveConfig{}, &ExecutiveConfig::stuck_limit, {1});
  expect_refused(ExecutiveConfig{}, &ExecutiveConfig::stuck_limit, {0, -1}, "stuck_limit");
}

}  // namespace
}  // namespace fleetmap::planning
