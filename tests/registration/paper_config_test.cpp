#include "fleetmap/registration/paper_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(PaperConfig, DefaultsAreValid) { EXPECT_TRUE(PaperConfig{}.validate()); }

TEST(PaperConfig, VoxelsAndFeaturesHaveGrowingScales) {
  const PaperConfig config;
  expect_accepted(config, &PaperConfig::voxel_m, {0.05f, config.feature_voxel_m});
  expect_refused(config, &PaperConfig::voxel_m, {0.04f, 2.1f, kNaN<float>}, "paper.voxel");
  expect_refused(config, &PaperConfig::voxel_m, {config.feature_voxel_m + 0.1f}, "paper.feature_voxel");
  expect_refused(config, &PaperConfig::feature_voxel_m, {5.1f, kNaN<float>}, "paper.feature_voxel");
  expect_refused(config, &PaperConfig::feature_radius_m, {config.feature_voxel_m, 20.1f, kNaN<float>},
                 "paper.feature_radius");
}

TEST(PaperConfig, CountsAndSharesAreBounded) {
  expect_accepted(PaperConfig{}, &PaperConfig::normal_neighbours, {3});
  expect_refused(PaperConfig{}, &PaperConfig::normal_neighbours, {2, -1}, "paper.normal_neighbours");
  expect_refused(PaperConfig{}, &PaperConfig::ransac_iterations, {0}, "paper.ransac_iterations");
  expect_refused(PaperConfig{}, &PaperConfig::icp_iterations, {0}, "icp_iterations");
  expect_accepted(PaperConfig{}, &PaperConfig::min_side_ratio, {0.0, 0.99});
  expect_refused(PaperConfig{}, &PaperConfig::min_side_ratio, {-0.1, 1.0, kNaN<double>},
                 "paper.min_side_ratio");
  expect_accepted(PaperConfig{}, &PaperConfig::min_inlier_fraction, {0.0, 1.0});
  expect_refused(PaperConfig{}, &PaperConfig::min_inlier_fraction, {-0.1, 1.1, kNaN<double>},
                 "paper.min_inlier_fraction");
}

TEST(PaperConfig, DistancesArePositive) {
  expect_refused(PaperConfig{}, &PaperConfig::ransac_inlier_m, {0.0, -1.0, kNaN<double>},
                 "paper.ransac_inlier");
  expect_refused(PaperConfig{}, &PaperConfig::inlier_m, {0.0, -1.0, kNaN<double>}, "inlier_distance");
  expect_refused(PaperConfig{}, &PaperConfig::max_rmse_m, {0.0, -1.0, kNaN<double>}, "paper.max_rmse");
}

}  // namespace
}  // namespace fleetmap::registration
