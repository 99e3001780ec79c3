#include "fleetmap/exchange/submap_transfer_config.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = SubmapTransferConfig;

constexpr std::uint32_t kChunk = 8192;  // B, of which submaps are transferred

TEST(SubmapTransferConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(SubmapTransferConfig, BurstAndRequestsHoldAChunk) {
  expect_accepted(Config{}, &Config::bytes_per_second, {1e-3, 1e9});
  expect_refused(Config{}, &Config::bytes_per_second, {0.0, -1.0, kNaN<double>, kInfinity<double>},
                 "bytes_per_second");
  expect_accepted(Config{}, &Config::burst_bytes, {double{kChunk}});
  expect_refused(Config{}, &Config::burst_bytes, {double{kChunk} - 1.0, kNaN<double>, kInfinity<double>},
                 "burst_bytes");
  expect_accepted(Config{}, &Config::request_bytes, {kChunk});
  expect_refused(Config{}, &Config::request_bytes, {kChunk - 1}, "request_bytes");
}

TEST(SubmapTransferConfig, TheWindowIsValidAndHoldsAChunk) {
  expect_refused(
      Config{}, [](Config& c) { c.window.target_s = 0.0; }, "window.target_s");
  expect_refused(
      Config{}, [](Config& c) { c.window.step_bytes = c.window.min_bytes = kChunk - 1; }, "window.min_bytes");
}

TEST(SubmapTransferConfig, TimesArePositiveAndOrdered) {
  const Config config;
  expect_accepted(config, &Config::max_distrust, {config.first_distrust});
  expect_refused(config, &Config::max_distrust, {config.first_distrust - Duration{1}}, "max_distrust");
  expect_refused(config, &Config::first_distrust, {Duration::zero()}, "first_distrust");
  expect_refused(config, &Config::store_pause, {Duration::zero()}, "store_pause");
  expect_accepted(config, &Config::peer_timeout, {config.digest_period + Duration{1}});
  expect_refused(config, &Config::peer_timeout, {config.digest_period}, "peer_timeout");
  expect_refused(config, &Config::digest_period, {Duration::zero(), Duration{-1}}, "digest_period");
  expect_accepted(config, &Config::max_timeout, {config.min_timeout});
  expect_refused(config, &Config::max_timeout, {config.min_timeout - Duration{1}}, "max_timeout");
  expect_refused(config, &Config::min_timeout, {Duration::zero(), Duration{-1}}, "min_timeout");
}

TEST(SubmapTransferConfig, CountsAreBounded) {
  expect_accepted(Config{}, &Config::max_ranges, {1, 1024});
  expect_refused(Config{}, &Config::max_ranges, {0, 1025}, "max_ranges");
  expect_accepted(Config{}, &Config::max_queued_chunks, {1});
  expect_refused(Config{}, &Config::max_queued_chunks, {0}, "max_queued_chunks");
}

}  // namespace
}  // namespace fleetmap::exchange
