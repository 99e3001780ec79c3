#include "fleetmap/localization/ekf_config.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::localization {
namespace {

using fleetmap::testing::kNaN;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The error is about the named field.
void expect_refused(const EkfConfig& config, const std::string& field) {
  const Status valid = config.validate();
  ASSERT_FALSE(valid) << field;
  EXPECT_EQ(valid.error().message.rfind(field + ": ", 0), 0u) << valid.error().message;
}

TEST(EkfConfig, DefaultsAreValid) { EXPECT_TRUE(EkfConfig{}.validate()); }

TEST(EkfConfig, WhatMustBePositiveIsFiniteAndAboveZero) {
  for (const double wrong : {0.0, -1.0, kNaN<double>, kInfinity}) {
    EkfConfig config;
    config.imu.gyro_noise = wrong;
    expect_refused(config, "imu.gyro_noise");
    config = {};
    config.gps.sigma_floor = wrong;
    expect_refused(config, "gps.sigma_floor");
    config = {};
    config.wheel.gate = wrong;
    expect_refused(config, "wheel.gate");
    config = {};
    config.motion.tilt_time = wrong;
    expect_refused(config, "motion.tilt_time");
    config = {};
    config.history = wrong;
    expect_refused(config, "history");
  }
}

TEST(EkfConfig, WhatMayBeZeroMayNotBeNegative) {
  EkfConfig config;
  config.imu.gyro_bias_walk = config.gps.correlation_time = config.wheel.turn_offset = 0.0;
  config.gps.correlated_share = config.max_lateness = config.max_extrapolation = 0.0;
  EXPECT_TRUE(config.validate());
  for (const double wrong : {-1e-9, kNaN<double>, kInfinity}) {
    config = {};
    config.gps.correlation_time = wrong;
    expect_refused(config, "gps.correlation_time");
    config = {};
    config.max_lateness = wrong;
    expect_refused(config, "max_lateness");
  }
}

TEST(EkfConfig, LimitsBetweenFieldsHold) {
  EkfConfig config;
  config.gps.correlated_share = 0.995;
  expect_refused(config, "gps.correlated_share");
  config = {};
  config.gps.sigma_ceiling = 0.5 * config.gps.sigma_floor;
  expect_refused(config, "gps.sigma_ceiling");
  config.gps.sigma_ceiling = kInfinity;
  expect_refused(config, "gps.sigma_ceiling");
  config = {};
  config.gps.initial_fixes = 0;
  expect_refused(config, "gps.initial_fixes");
  config = {};
  config.max_lateness = config.history + 0.1;
  expect_refused(config, "max_lateness");
  config.max_lateness = config.history;
  EXPECT_TRUE(config.validate());
}

TEST(EkfConfig, GeometryIsChecked) {
  EkfConfig config;
  config.mounting.T_base_imu.translation().y() = kNaN<double>;
  expect_refused(config, "mounting.T_base_imu");
  config = {};
  config.mounting.p_base_antenna.z() = kInfinity;
  expect_refused(config, "mounting.p_base_antenna");
  config = {};
  config.site_origin = GeoPoint{2.0, 0.0, 0.0};
  expect_refused(config, "site_origin");
  config.site_origin = GeoPoint{1.5, 3.0, 0.0};
  EXPECT_TRUE(config.validate());
}

}  // namespace
}  // namespace fleetmap::localization
