#include "fleetmap/cloud/encode_within.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::cloud {
namespace {

FitConfig within(std::size_t max_bytes) {
  FitConfig config;
  config.max_bytes = max_bytes;
  return config;
}

TEST(CloudWithinABudget, IsTheThinnedOneToHalfAStepOfTheCoding) {
  const PointCloud scene = testing::street_scene(20'000, 3);
  FitConfig config = within(6'000);
  config.voxel_over_resolution = 4.0;
  const auto fitted = encode_within(scene, config);
  ASSERT_TRUE(fitted) << fitted.error().message;
  EXPECT_GT(fitted->voxel_m, config.min_voxel_m);
  EXPECT_NEAR(fitted->resolution_m, static_cast<double>(fitted->voxel_m) / 4.0, 1e-7);
  const PointCloud thinned = voxel_downsample(scene, fitted->voxel_m);
  ASSERT_EQ(fitted->decoded.size(), thinned.size());
  const KdTree tree(fitted->decoded);
  for (const Eigen::Vector3f& p : thinned.points) {
    const auto nearest = tree.nearest(p);
    ASSERT_TRUE(nearest);
    EXPECT_LE((fitted->decoded.points[nearest->index] - p).cwiseAbs().maxCoeff(),
              0.5 * fitted->resolution_m + 1e-4);
  }
}

TEST(CloudWithinABudget, IsFinerWhereTheBudgetIsLarger) {
  const PointCloud scene = testing::street_scene(20'000, 5);
  float coarser = FitConfig{}.max_voxel_m;
  for (const std::size_t budget : {500u, 1'500u, 4'500u, 13'500u}) {
    const auto fitted = encode_within(scene, within(budget));
    ASSERT_TRUE(fitted) << fitted.error().message;
    EXPECT_LE(fitted->bytes.size(), budget);
    EXPECT_LT(fitted->voxel_m, 0.8f * coarser) << budget;
    coarser = fitted->voxel_m;
  }
}

TEST(CloudWithinABudget, FitsHoweverFewTrialsThereAre) {
  const PointCloud scene = testing::street_scene(20'000, 6);
  for (const int trials : {3, 4, 8}) {
    for (const std::size_t budget : {300u, 3'000u}) {
      FitConfig config = within(budget);
      config.max_encodings = trials;
      const auto fitted = encode_within(scene, config);
      ASSERT_TRUE(fitted) << fitted.error().message;
      EXPECT_LE(fitted->bytes.size(), budget);
      EXPECT_LE(fitted->encodings, trials);
    }
  }
}

TEST(CloudWithinABudget, HasIntensitiesWhereTheyAreAskedFor) {
  const PointCloud scene = testing::street_scene(20'000, 7);
  FitConfig config = within(6'000);
  const auto without = encode_within(scene, config);
  ASSERT_TRUE(without);
  EXPECT_FALSE(without->decoded.has_intensities());
  config.encode_intensities = true;
  const auto with = encode_within(scene, config);
  ASSERT_TRUE(with);
  EXPECT_TRUE(with->decoded.has_intensities());
  EXPECT_GT(with->voxel_m, without->voxel_m) << "they take room";
}

/// Bytes of few points hardly fall with the voxel until many share one.
TEST(CloudWithinABudget, IsNearlyFullAlsoWherePointsAreSparse) {
  for (const auto& [points, budget] : std::vector<std::pair<std::size_t, std::size_t>>{
           {2'000, 4'000}, {2'000, 5'000}, {6'000, 12'000}, {12'000, 25'000}, {13'000, 25'000}}) {
    const auto fitted = encode_within(testing::street_scene(points, 7), within(budget));
    ASSERT_TRUE(fitted) << fitted.error().message;
    EXPECT_LE(fitted->bytes.size(), budget);
    EXPECT_GT(static_cast<double>(fitted->bytes.size()), 0.9 * static_cast<double>(budget))
        << points << " points";
  }
}

TEST(CloudWithinABudget, LeavesOutPointsThatAreNotFinite) {
  PointCloud scene = testing::street_scene(500, 7);
  scene.points[3].x() = std::numeric_limits<float>::quiet_NaN();
  const auto fitted = encode_within(scene, {});
  ASSERT_TRUE(fitted);
  for (const Eigen::Vector3f& p : fitted->decoded.points) EXPECT_TRUE(p.allFinite());
}

}  // namespace
}  // namespace fleetmap::cloud
