#include "fleetmap/agent/submap_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(SubmapConfig, DefaultsAreValid) { EXPECT_TRUE(SubmapConfig{}.validate()); }

TEST(SubmapConfig, TheRoundingIsFinerThanTheVoxel) {
  const SubmapConfig config;
  expect_accepted(config, &SubmapConfig::voxel, {config.resolution, 5.0});
  expect_refused(config, &SubmapConfig::voxel, {0.009, 5.1, kNaN<double>}, "voxel");
  expect_accepted(config, &SubmapConfig::resolution, {0.001, config.voxel});
  expect_refused(config, &SubmapConfig::resolution, {0.0009, config.voxel + 0.01, kNaN<double>},
                 "resolution");
}

TEST(SubmapConfig, SpacingsAndBytesAreBounded) {
  expect_accepted(SubmapConfig{}, &SubmapConfig::scan_spacing, {0.0});
  expect_refused(SubmapConfig{}, &SubmapConfig::scan_spacing, {-0.1, kNaN<double>}, "scan_spacing");
  expect_accepted(SubmapConfig{}, &SubmapConfig::scan_angle, {0.0});
  expect_refused(SubmapConfig{}, &SubmapConfig::scan_angle, {-0.1, kNaN<double>}, "scan_angle");
  expect_accepted(SubmapConfig{}, &SubmapConfig::max_bytes, {10'000u, 8u << 20});
  expect_refused(SubmapConfig{}, &SubmapConfig::max_bytes, {9'999u, (8u << 20) + 1}, "max_bytes");
}

}  // namespace
}  // namespace fleetmap::agent
