#include "fleetmap/exchange/reconcile_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

using Config = ReconcileConfig;

TEST(ReconcileConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(ReconcileConfig, PeriodsArePositiveAndOrdered) {
  const Config config;
  expect_accepted(config, &Config::digest_min_period, {Duration{1}, config.digest_max_period});
  expect_refused(config, &Config::digest_min_period,
                 {Duration::zero(), Duration{-1}, config.digest_max_period + Duration{1}},
                 "digest_min_period");
  expect_accepted(config, &Config::max_store_pause, {config.store_pause});
  expect_refused(config, &Config::max_store_pause, {config.store_pause - Duration{1}}, "max_store_pause");
  for (Duration Config::*period : {&Config::near_period, &Config::store_pause}) {
    expect_accepted(config, period, {Duration{1}});
    expect_refused(config, period, {Duration::zero(), Duration{-1}}, "near_period and store_pause");
  }
  for (Duration Config::*timeout : {&Config::timeout, &Config::peer_timeout}) {
    expect_accepted(config, timeout, {Duration{1}});
    expect_refused(config, timeout, {Duration::zero(), Duration{-1}}, "timeout");
  }
  expect_accepted(config, &Config::grace, {Duration::zero()});
  expect_refused(config, &Config::grace, {Duration{-1}}, "grace");
}

TEST(ReconcileConfig, CountsAreBounded) {
  expect_accepted(Config{}, &Config::max_ranges, {1, 256});
  expect_refused(Config{}, &Config::max_ranges, {0, 257}, "max_ranges");
  expect_accepted(Config{}, &Config::max_items, {1});
  expect_refused(Config{}, &Config::max_items, {0}, "max_items");
  expect_accepted(Config{}, &Config::max_barren, {1});
  expect_refused(Config{}, &Config::max_barren, {0, -1}, "max_barren");
}

}  // namespace
}  // namespace fleetmap::exchange
