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

using Config = ExecutiveConfig;

TEST(ExecutiveConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(ExecutiveConfig, TimesAreBounded) {
  expect_positive(Config{}, {{&Config::lost_after, "lost_after"},
                             {&Config::orphan_wait, "orphan_wait"},
                             {&Config::offer_period, "offer_period"},
                             {&Config::stuck_retry, "stuck_retry"},
                             {&Config::stop_patience, "stop_patience"},
                             {&Config::meeting_timeout, "meeting_timeout"}});
  expect_not_negative(Config{}, {{&Config::listen, "listen"}, {&Config::offer_gain, "offer_gain"}});
}

TEST(ExecutiveConfig, BatteryAndCountsAreBounded) {
  expect_accepted(Config{}, &Config::low_battery, {0.0, 0.99});
  expect_refused(Config{}, &Config::low_battery, {-0.1, 1.0, kNaN<double>}, "low_battery");
  expect_accepted(Config{}, &Config::row_attempts, {1});
  expect_refused(Config{}, &Config::row_attempts, {0, -1}, "row_attempts");
  expect_accepted(Config{}, &Config::stuck_limit, {1});
  expect_refused(Config{}, &Config::stuck_limit, {0, -1}, "stuck_limit");
}

}  // namespace
}  // namespace fleetmap::planning
