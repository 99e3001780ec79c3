#include "fleetmap/cloud/fit_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(FitConfig, DefaultsAreValid) { EXPECT_TRUE(FitConfig{}.validate()); }

TEST(FitConfig, VoxelsAreFiniteAndOrdered) {
  const FitConfig config;
  expect_accepted(config, &FitConfig::min_voxel_m, {1e-4f, config.max_voxel_m});
  expect_refused(config, &FitConfig::min_voxel_m, {9e-5f, 0.0f, kNaN<float>, kInfinity<float>},
                 "min_voxel_m");
  expect_accepted(config, &FitConfig::max_voxel_m, {config.min_voxel_m});
  expect_refused(config, &FitConfig::max_voxel_m, {0.9f * config.min_voxel_m, kNaN<float>, kInfinity<float>},
                 "max_voxel_m");
}

TEST(FitConfig, BudgetRatioAndTrialsAreBounded) {
  expect_accepted(FitConfig{}, &FitConfig::max_bytes, {64});
  expect_refused(FitConfig{}, &FitConfig::max_bytes, {63, 0}, "max_bytes");
  expect_accepted(FitConfig{}, &FitConfig::voxel_over_resolution, {1.0, 100.0});
  expect_refused(FitConfig{}, &FitConfig::voxel_over_resolution, {0.99, 100.1, kNaN<double>},
                 "voxel_over_resolution");
  expect_accepted(FitConfig{}, &FitConfig::max_encodings, {3});
  expect_refused(FitConfig{}, &FitConfig::max_encodings, {2, 0, -1}, "max_encodings");
}

}  // namespace
}  // namespace fleetmap::cloud
