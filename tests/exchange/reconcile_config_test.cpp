#include "fleetmap/exchange/reconcile_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

TEST(ReconcileConfig, DefaultsAreValid) { EXPECT_TRUE(ReconcileConfig{}.validate()); }

TEST(ReconcileConfig, PeriodsArePositiveAndOrdered) {
  const ReconcileConfig config;
  expect_accepted(config, &ReconcileConfig::digest_min_period, {Duration{1}, config.digest_max_period});
  expect_refused(config, &ReconcileConfig::digest_min_period,
                 {Duration::zero(), Duration{-1}, config.digest_max_period + Duration{1}},
                 "digest_min_period");
  expect_accepted(config, &ReconcileConfig::max_store_pause, {config.store_pause});
  expect_refused(config, &ReconcileConfig::max_store_pause, {config.store_pause - Duration{1}},
                 "max_store_pause");
  for (Duration ReconcileConfig::*period : {&ReconcileConfig::near_period, &ReconcileConfig::store_pause}) {
    expect_accepted(config, period, {Duration{1}});
    expect_refused(config, period, {Duration::zero(), Duration{-1}}, "near_period and store_pause");
  }
  for (Duration ReconcileConfig::*timeout : {&ReconcileConfig::timeout, &ReconcileConfig::peer_timeout}) {
    expect_accepted(config, timeout, {Duration{1}});
    expect_refused(config, timeout, {Duration::zero(), Duration{-1}}, "timeout");
  }
  expect_accepted(config, &ReconcileConfig::grace, {Duration::zero()});
  expect_refused(config, &ReconcileConfig::grace, {Duration{-1}}, "grace");
}

TEST(ReconcileConfig, CountsAreBounded) {
  expect_accepted(ReconcileConfig{}, &ReconcileConfig::max_ranges, {1, 256});
  expect_refused(ReconcileConfig{}, &ReconcileConfig::max_ranges, {0, 257}, "max_ranges");
  expect_accepted(ReconcileConfig{}, &ReconcileConfig::max_items, {1});
  expect_refused(ReconcileConfig{}, &ReconcileConfig::max_items, {0}, "max_items");
  expect_accepted(ReconcileConfig{}, &ReconcileConfig::max_barren, {1});
  expect_refused(ReconcileConfig{}, &ReconcileConfig::max_barren, {0, -1}, "max_barren");
}

}  // namespace
}  // namespace fleetmap::exchange
