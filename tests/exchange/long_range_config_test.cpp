#include "fleetmap/exchange/long_range_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(LongRangeConfig, DefaultsAreValid) { EXPECT_TRUE(LongRangeConfig{}.validate()); }

TEST(LongRangeConfig, TheRateIsPositive) {
  expect_accepted(LongRangeConfig{}, &LongRangeConfig::fleet_bytes_per_second, {1e-3, 1e9});
  expect_refused(LongRangeConfig{}, &LongRangeConfig::fleet_bytes_per_second,
                 {0.0, -1.0, kNaN<double>, kInfinity<double>}, "fleet_bytes_per_second");
}

TEST(LongRangeConfig, BurstsAreBounded) {
  for (const double good : {0.0, 10.0}) {
    LongRangeConfig config;
    config.pace.burst_seconds = good;
    EXPECT_TRUE(config.validate()) << good;
  }
  for (const double wrong : {-0.1, 10.1, kNaN<double>})
    expect_refused(
        LongRangeConfig{}, [&](LongRangeConfig& c) { c.pace.burst_seconds = wrong; }, "burst_seconds");
  for (const double wrong : {-1.0, 1e6 + 1.0, kNaN<double>})
    expect_refused(
        LongRangeConfig{}, [&](LongRangeConfig& c) { c.pace.min_burst_bytes = wrong; }, "min_burst_bytes");
  for (const double wrong : {0.99, 100.1, kNaN<double>})
    expect_refused(
        LongRangeConfig{}, [&](LongRangeConfig& c) { c.pace.peak = wrong; }, "peak");
  expect_accepted(LongRangeConfig{}, &LongRangeConfig::small_reserve_bytes, {0.0, 1e6});
  expect_refused(LongRangeConfig{}, &LongRangeConfig::small_reserve_bytes, {-1.0, 1e6 + 1.0, kNaN<double>},
                 "small_reserve_bytes");
}

TEST(LongRangeConfig, EachQueueHoldsAMessage) {
  for (std::size_t LongRangeConfig::*queue :
       {&LongRangeConfig::max_small, &LongRangeConfig::max_backfill, &LongRangeConfig::max_fragments}) {
    expect_accepted(LongRangeConfig{}, queue, {1});
    expect_refused(LongRangeConfig{}, queue, {0}, "max_small, max_backfill and max_fragments");
  }
}

TEST(LongRangeConfig, AMessageToAllCrossesTheMediumOncePerOtherRobotUnlessItIsMulticast) {
  LongRangeConfig config;
  EXPECT_EQ(config.copies(5), 4u);
  EXPECT_EQ(config.copies(2), 1u);
  EXPECT_EQ(config.copies(1), 1u);
  EXPECT_EQ(config.copies(0), 1u);
  config.multicast = true;
  EXPECT_EQ(config.copies(5), 1u);
}

}  // namespace
}  // namespace fleetmap::exchange
