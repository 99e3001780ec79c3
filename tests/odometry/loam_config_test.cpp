#include "fleetmap/odometry/loam_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::odometry {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = LoamConfig;

TEST(LoamConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(LoamConfig, NumbersLieInTheirRanges) {
  struct Range {
    double Config::*value;
    double low, high;
    const char* name;
  };
  for (const Range& range : {Range{&Config::range_noise, 1e-4, 1.0, "range_noise"},
                             {&Config::feature_half_width, 0.01, 5.0, "feature_half_width"},
                             {&Config::match_spacing, 0.02, 10.0, "match_spacing"},
                             {&Config::insert_spacing, 0.02, 10.0, "insert_spacing"},
                             {&Config::linear_acceleration, 1e-3, 1000.0, "linear_acceleration"},
                             {&Config::gyro_noise, 1e-5, 10.0, "gyro_noise"},
                             {&Config::edge_noise, 1e-3, 10.0, "edge_noise"},
                             {&Config::information_deflation, 1.0, 1e6, "information_deflation"}}) {
    expect_accepted(Config{}, range.value, {range.low, range.high});
    expect_refused(Config{}, range.value,
                   {0.99 * range.low, 1.01 * range.high, kNaN<double>, kInfinity<double>},
                   std::string("odometry.") + range.name);
  }
  expect_accepted(Config{}, &Config::min_inlier_fraction, {0.0, 1.0});
  expect_refused(Config{}, &Config::min_inlier_fraction, {-0.01, 1.01, kNaN<double>},
                 "odometry.min_inlier_fraction");
}

TEST(LoamConfig, CountsLieInTheirRanges) {
  struct Range {
    int Config::*value;
    int low, high;
    const char* name;
  };
  for (const Range& range :
       {Range{&Config::max_map_windows, 10'000, 100'000'000, "max_map_windows"},
        {&Config::max_iterations, 1, 100, "max_iterations"},
        {&Config::min_matches, 6, 1'000'000, "min_matches"},
        {&Config::lost_scans_before_restart, 1, 1'000'000, "lost_scans_before_restart"}}) {
    expect_accepted(Config{}, range.value, {range.low, range.high});
    expect_refused(Config{}, range.value, {range.low - 1, range.high + 1},
                   std::string("odometry.") + range.name);
  }
}

TEST(LoamConfig, RangesAndResolutionsAreOrdered) {
  const Config config;
  expect_refused(config, &Config::min_range, {config.max_range}, "odometry.min_range");
  expect_refused(config, &Config::coarse_resolution, {config.fine_resolution}, "odometry.coarse_resolution");
  // The map must hold all that a scan sees.
  expect_accepted(config, &Config::map_radius, {config.max_range});
  expect_refused(config, &Config::map_radius, {config.max_range - 0.1, 2000.1}, "odometry.map_radius");
}

TEST(LoamConfig, MountsAreRigid) {
  expect_refused(
      Config{}, [](Config& c) { c.T_base_lidar.linear() *= 1.01; }, "odometry.T_base_lidar");
  expect_refused(
      Config{}, [](Config& c) { c.T_base_lidar.linear().col(0) *= -1.0; }, "odometry.T_base_lidar");
  expect_refused(
      Config{}, [](Config& c) { c.T_base_lidar.translation().x() = kNaN<double>; }, "odometry.T_base_lidar");
  expect_refused(
      Config{}, [](Config& c) { c.q_base_imu.coeffs() *= 1.01; }, "odometry.q_base_imu");
  expect_refused(
      Config{}, [](Config& c) { c.q_base_imu.w() = kNaN<double>; }, "odometry.q_base_imu");
}

}  // namespace
}  // namespace fleetmap::odometry
