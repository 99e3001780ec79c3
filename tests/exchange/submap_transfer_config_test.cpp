#include "fleetmap/exchange/submap_transfer_config.hpp"

#include <gtest/gtest.h>

#include "exchange/submap_chunks.hpp"
#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(SubmapTransferConfig, DefaultsAreValid) { EXPECT_TRUE(SubmapTransferConfig{}.validate()); }

TEST(SubmapTransferConfig, BurstAndRequestsHoldAChunk) {
  expect_accepted(SubmapTransferConfig{}, &SubmapTransferConfig::bytes_per_second, {1e-3, 1e9});
  expect_refused(SubmapTransferConfig{}, &SubmapTransferConfig::bytes_per_second,
                 {0.0, -1.0, kNaN<double>, kInfinity<double>}, "bytes_per_second");
  expect_accepted(SubmapTransferConfig{}, &SubmapTransferConfig::burst_bytes, {double{kChunk}});
  expect_refused(SubmapTransferConfig{}, &SubmapTransferConfig::burst_bytes,
                 {double{kChunk} - 1.0, kNaN<double>, kInfinity<double>}, "burst_bytes");
  expect_accepted(SubmapTransferConfig{}, &SubmapTransferConfig::request_bytes, {kChunk});
  expect_refused(SubmapTransferConfig{}, &SubmapTransferConfig::request_bytes, {kChunk - 1}, "request_bytes");
}

TEST(SubmapTransferConfig, TheWindowIsValidAndHoldsAChunk) {
  expect_refused(
      SubmapTransferConfig{}, [](SubmapTransferConfig& c) { c.window.target_s = 0.0; }, "window.target_s");
  expect_refused(
      SubmapTransferConfig{},
      [](SubmapTransferConfig& c) { c.window.step_bytes = c.window.min_bytes = kChunk - 1; },
      "window.min_bytes");
}

TEST(SubmapTransferConfig, TimesArePositiveAndOrdered) {
  const SubmapTransferConfig config;
  expect_accepted(config, &SubmapTransferConfig::max_distrust, {config.first_distrust});
  expect_refused(config, &SubmapTransferConfig::max_distrust, {config.first_distrust - Duration{1}},
                 "max_distrust");
  expect_refused(config, &SubmapTransferConfig::first_distrust, {Duration::zero()}, "first_distrust");
  expect_refused(config, &SubmapTransferConfig::store_pause, {Duration::zero()}, "store_pause");
  expect_accepted(config, &SubmapTransferConfig::peer_timeout, {config.digest_period + Duration{1}});
  expect_refused(config, &SubmapTransferConfig::peer_timeout, {config.digest_period}, "peer_timeout");
  expect_refused(config, &SubmapTransferConfig::digest_period, {Duration::zero(), Duration{-1}},
                 "digest_period");
  expect_accepted(config, &SubmapTransferConfig::max_timeout, {config.min_timeout});
  expect_refused(config, &SubmapTransferConfig::max_timeout, {config.min_timeout - Duration{1}},
                 "max_timeout");
  expect_refused(config, &SubmapTransferConfig::min_timeout, {Duration::zero(), Duration{-1}}, "min_timeout");
}

TEST(SubmapTransferConfig, CountsAreBounded) {
  expect_accepted(SubmapTransferConfig{}, &SubmapTransferConfig::max_ranges, {1, 1024});
  expect_refused(SubmapTransferConfig{}, &SubmapTransferConfig::max_ranges, {0, 1025}, "max_ranges");
  expect_accepted(SubmapTransferConfig{}, &SubmapTransferConfig::max_queued_chunks, {1});
  expect_refused(SubmapTransferConfig{}, &SubmapTransferConfig::max_queued_chunks, {0}, "max_queued_chunks");
}

}  // namespace
}  // namespace fleetmap::exchange
