#include "fleetmap/bus/local_network_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = LocalNetworkConfig;

TEST(LocalNetworkConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

void expect_names(const Config& config, const std::string& name) {
  const auto valid = config.validate();
  ASSERT_FALSE(valid) << name;
  EXPECT_NE(valid.error().message.find(name), std::string::npos) << name << ": " << valid.error().message;
}

/// As expect_refused, whose call GCC 12 cannot compile with a field of a field.
template <class Value>
void expect_refused_in(RadioConfig Config::*radio, Value RadioConfig::*field, Value wrong,
                       const std::string& name) {
  Config config;
  (config.*radio).*field = wrong;
  expect_names(config, name);
}

void expect_checked(RadioConfig Config::*radio, const std::string& name) {
  for (const double wrong : {0.0, -1.0, kNaN<double>, kInfinity<double>})
    expect_refused_in(radio, &RadioConfig::rate_bit_s, wrong, name + ".rate_bit_s");
  for (const double wrong : {-0.1, 1.0, kNaN<double>})
    expect_refused_in(radio, &RadioConfig::loss, wrong, name + ".loss");
  for (const double wrong : {-0.1, kNaN<double>, kInfinity<double>})
    expect_refused_in(radio, &RadioConfig::max_range, wrong, name + ".max_range");
  expect_refused_in(radio, &RadioConfig::delay, Duration{-1}, name + ".delay");
  expect_refused_in(radio, &RadioConfig::queue_capacity, std::size_t{0}, name + ".queue_capacity");
  Config config;
  (config.*radio).overhead.max_datagram_payload = 0;
  expect_names(config, name + ".overhead.max_datagram_payload");
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
