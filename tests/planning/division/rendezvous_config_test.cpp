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

TEST(RendezvousConfig, DefaultsAreValid) { EXPECT_TRUE(RendezvousConfig{}.validate()); }

TEST(RendezvousConfig, RatesAndLengthsArePositive) {
  expect_positive(RendezvousConfig{}, {{&RendezvousConfig::c_max, "c_max"},
                                       {&RendezvousConfig::bandwidth, "bandwidth"},
                                       {&RendezvousConfig::spacing, "spacing"},
                                       {&RendezvousConfig::sample_period, "sample_period"}});
  expect_not_negative(RendezvousConfig{}, {{&RendezvousConfig::map_bytes_per_metre, "map_bytes_per_metre"},
                                           {&RendezvousConfig::stop_overhead, "stop_overhead"},
                                           {&RendezvousConfig::min_gain, "min_gain"}});
  expect_accepted(RendezvousConfig{}, &RendezvousConfig::efficiency, {0.01, 1.0});
  expect_refused(RendezvousConfig{}, &RendezvousConfig::efficiency, {0.0, 1.01, kNaN<double>}, "efficiency");
}

TEST(RendezvousConfig, RobotsThatWaitReachEachOther) {
  const RendezvousConfig config;
  expect_accepted(config, &RendezvousConfig::spacing, {config.c_max - 0.1});
  expect_refused(config, &RendezvousConfig::spacing, {config.c_max}, "spacing");
}

}  // namespace
}  // namespace fleetmap::planning
