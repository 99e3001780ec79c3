#include "fleetmap/bus/local_network_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::bus {
namespace {

using testing::expect_accepted;
using testing::expect_refused;
using testing::kInfinity;
using testing::kNaN;

using Config = LocalNetworkConfig;

TEST(LocalNetworkConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

void expect_checked(RadioConfig Config::*radio, const std::string& name) {
  const auto refused = [&](auto RadioConfig::*field, auto value, const std::string& of) {
    expect_refused(
        Config{}, [&](Config& c) { c.*radio.*field = value; }, name + "." + of);
  };
  for (const double wrong : {0.0, -1.0, kNaN<double>, kInfinity<double>})
    refused(&RadioConfig::rate_bit_s, wrong, "rate_bit_s");
  for (const double wrong : {-0.1, 1.0, kNaN<double>}) refused(&RadioConfig::loss, wrong, "loss");
  for (const double wrong : {-0.1, kNaN<double>, kInfinity<double>})
    refused(&RadioConfig::max_range, wrong, "max_range");
  refused(&RadioConfig::delay, Duration{-1}, "delay");
  refused(&RadioConfig::queue_capacity, std::size_t{0}, "queue_capacity");
  expect_refused(
      Config{}, [&](Config& c) { (c.*radio).overhead.max_datagram_payload = 0; },
      name + ".overhead.max_datagram_payload");
}

TEST(LocalNetworkConfig, BothRadiosAreChecked) {
  expect_checked(&Config::long_range, "long_range");
  expect_checked(&Config::short_range, "short_range");
}

TEST(LocalNetworkConfig, ARadioMayLoseNothingAndReachEverywhere) {
  Config config;
  config.long_range.loss = config.long_range.max_range = 0.0;
  config.long_range.delay = Duration::zero();
  EXPECT_TRUE(config.validate());
}

TEST(LocalNetworkConfig, QueueAndTimesAreBounded) {
  expect_accepted(Config{}, &Config::onboard_queue_capacity, {1});
  expect_refused(Config{}, &Config::onboard_queue_capacity, {0}, "onboard_queue_capacity");
  expect_accepted(Config{}, &Config::perception_time, {Duration::zero()});
  expect_refused(Config{}, &Config::perception_time, {Duration{-1}}, "perception_time");
  expect_accepted(Config{}, &Config::background_time, {Duration::zero()});
  expect_refused(Config{}, &Config::background_time, {Duration{-1}}, "background_time");
}

}  // namespace
}  // namespace fleetmap::bus
