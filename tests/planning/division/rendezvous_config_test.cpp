#include "fleetmap/planning/division/rendezvous_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_not_negative;
using fleetmap::testing::expect_positive;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = RendezvousConfig;

TEST(RendezvousConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(RendezvousConfig, RatesAndLengthsArePositive) {
  expect_positive(Config{}, {{&Config::c_max, "c_max"},
                             {&Config::bandwidth, "bandwidth"},
                             {&Config::spacing, "spacing"},
                             {&Config::sample_period, "sample_period"}});
  expect_not_negative(Config{}, {{&Config::map_bytes_per_metre, "map_bytes_per_metre"},
                                 {&Config::stop_overhead, "stop_overhead"},
                                 {&Config::min_gain, "min_gain"}});
  expect_accepted(Config{}, &Config::efficiency, {0.01, 1.0});
  expect_refused(Config{}, &Config::efficiency, {0.0, 1.01, kNaN<double>}, "efficiency");
}

TEST(RendezvousConfig, RobotsThatWaitReachEachOther) {
  const Config config;
  expect_accepted(config, &Config::spacing, {config.c_max - 0.1});
  expect_refused(config, &Config::spacing, {config.c_max}, "spacing");
}

}  // namespace
}  // namespace fleetmap::planning
