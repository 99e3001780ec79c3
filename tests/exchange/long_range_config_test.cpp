#include "fleetmap/exchange/long_range_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = LongRangeConfig;

TEST(LongRangeConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(LongRangeConfig, TheRateIsPositive) {
  expect_accepted(Config{}, &Config::fleet_bytes_per_second, {1e-3, 1e9});
  expect_refused(Config{}, &Config::fleet_bytes_per_second, {0.0, -1.0, kNaN<double>, kInfinity<double>},
                 "fleet_bytes_per_second");
}

TEST(LongRangeConfig, BurstsAreBounded) {
  for (const double good : {0.0, 10.0}) {
    Config config;
    config.pace.burst_seconds = good;
    EXPECT_TRUE(config.validate()) << good;
  }
  for (const double wrong : {-0.1, 10.1, kNaN<double>})
    expect_refused(
        Config{}, [&](Config& c) { c.pace.burst_seconds = wrong; }, "burst_seconds");
  for (const double wrong : {-1.0, 1e6 + 1.0, kNaN<double>})
    expect_refused(
        Config{}, [&](Config& c) { c.pace.min_burst_bytes = wrong; }, "min_burst_bytes");
  for (const double wrong : {0.99, 100.1, kNaN<double>})
    expect_refused(
        Config{}, [&](Config& c) { c.pace.peak = wrong; }, "peak");
  expect_accepted(Config{}, &Config::small_reserve_bytes, {0.0, 1e6});
  expect_refused(Config{}, &Config::small_reserve_bytes, {-1.0, 1e6 + 1.0, kNaN<double>},
                 "small_reserve_bytes");
}

TEST(LongRangeConfig, EachQueueHoldsAMessage) {
  for (std::size_t Config::*queue : {&Config::max_small, &Config::max_backfill, &Config::max_fragments}) {
    expect_accepted(Config{}, queue, {1});
    expect_refused(Config{}, queue, {0}, "max_small, max_backfill and max_fragments");
  }
}

TEST(LongRangeConfig, AMessageToAllCrossesTheMediumOncePerOtherRobotUnlessItIsMulticast) {
  Config config;
  EXPECT_EQ(config.copies(5), 4u);
  EXPECT_EQ(config.copies(2), 1u);
  EXPECT_EQ(config.copies(1), 1u);
  EXPECT_EQ(config.copies(0), 1u);
  config.multicast = true;
  EXPECT_EQ(config.copies(5), 1u);
}

}  // namespace
}  // namespace fleetmap::exchange
