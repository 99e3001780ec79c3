#include "fleetmap/agent/submap_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = SubmapConfig;

TEST(SubmapConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(SubmapConfig, TheRoundingIsFinerThanTheVoxel) {
  const Config config;
  expect_accepted(config, &Config::voxel, {config.resolution, 5.0});
  expect_refused(config, &Config::voxel, {0.009, 5.1, kNaN<double>}, "voxel");
  expect_accepted(config, &Config::resolution, {0.001, config.voxel});
  expect_refused(config, &Config::resolution, {0.0009, config.voxel + 0.01, kNaN<double>}, "resolution");
}

TEST(SubmapConfig, SpacingsAndBytesAreBounded) {
  expect_accepted(Config{}, &Config::scan_spacing, {0.0});
  expect_refused(Config{}, &Config::scan_spacing, {-0.1, kNaN<double>}, "scan_spacing");
  expect_accepted(Config{}, &Config::scan_angle, {0.0});
  expect_refused(Config{}, &Config::scan_angle, {-0.1, kNaN<double>}, "scan_angle");
  expect_accepted(Config{}, &Config::max_bytes, {10'000u, 8u << 20});
  expect_refused(Config{}, &Config::max_bytes, {9'999u, (8u << 20) + 1}, "max_bytes");
}

}  // namespace
}  // namespace fleetmap::agent
