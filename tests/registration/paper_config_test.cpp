#include "fleetmap/registration/paper_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = PaperConfig;

TEST(PaperConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(PaperConfig, VoxelsAndFeaturesHaveGrowingScales) {
  const Config config;
  expect_accepted(config, &Config::voxel_m, {0.05f, config.feature_voxel_m});
  expect_refused(config, &Config::voxel_m, {0.04f, 2.1f, kNaN<float>}, "paper.voxel");
  expect_refused(config, &Config::voxel_m, {config.feature_voxel_m + 0.1f}, "paper.feature_voxel");
  expect_refused(config, &Config::feature_voxel_m, {5.1f, kNaN<float>}, "paper.feature_voxel");
  expect_refused(config, &Config::feature_radius_m, {config.feature_voxel_m, 20.1f, kNaN<float>},
                 "paper.feature_radius");
}

TEST(PaperConfig, CountsAndSharesAreBounded) {
  expect_accepted(Config{}, &Config::normal_neighbours, {3});
  expect_refused(Config{}, &Config::normal_neighbours, {2, -1}, "paper.normal_neighbours");
  expect_refused(Config{}, &Config::ransac_iterations, {0}, "paper.ransac_iterations");
  expect_refused(Config{}, &Config::icp_iterations, {0}, "icp_iterations");
  expect_accepted(Config{}, &Config::min_side_ratio, {0.0, 0.99});
  expect_refused(Config{}, &Config::min_side_ratio, {-0.1, 1.0, kNaN<double>}, "paper.min_side_ratio");
  expect_accepted(Config{}, &Config::min_inlier_fraction, {0.0, 1.0});
  expect_refused(Config{}, &Config::min_inlier_fraction, {-0.1, 1.1, kNaN<double>},
                 "paper.min_inlier_fraction");
}

TEST(PaperConfig, DistancesArePositive) {
  expect_refused(Config{}, &Config::ransac_inlier_m, {0.0, -1.0, kNaN<double>}, "paper.ransac_inlier");
  expect_refused(Config{}, &Config::inlier_m, {0.0, -1.0, kNaN<double>}, "inlier_distance");
  expect_refused(Config{}, &Config::max_rmse_m, {0.0, -1.0, kNaN<double>}, "paper.max_rmse");
}

}  // namespace
}  // namespace fleetmap::registration
