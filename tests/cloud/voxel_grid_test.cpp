#include "fleetmap/cloud/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "cloud/scenes.hpp"

namespace fleetmap::cloud {
namespace {

using testing::street_scene;

std::tuple<long, long, long> cell_of(const Eigen::Vector3f& p, double voxel) {
  return {static_cast<long>(std::floor(p.x() / voxel)), static_cast<long>(std::floor(p.y() / voxel)),
          static_cast<long>(std::floor(p.z() / voxel))};
}

TEST(VoxelDownsample, GivesTheCentroidOfEveryVoxel) {
  const PointCloud cloud = street_scene(20'000, 1);
  const float voxel = 0.4f;
  std::map<std::tuple<long, long, long>, std::pair<Eigen::Vector3d, int>> expected;
  for (const auto& p : cloud.points) {
    auto& [sum, count] = expected.try_emplace(cell_of(p, 0.4f), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p.cast<double>();
    ++count;
  }
  const PointCloud thin = voxel_downsample(cloud, voxel);
  ASSERT_EQ(thin.size(), expected.size());
  EXPECT_EQ(thin.intensities.size(), thin.size());
  for (const auto& p : thin.points) {
    const auto found = expected.find(cell_of(p, 0.4f));
    ASSERT_NE(found, expected.end());
    EXPECT_LT((found->second.first / found->second.second - p.cast<double>()).norm(), 1e-4);
  }
}

TEST(VoxelDownsample, KeepsFirstHitOrder) {
  PointCloud cloud;
  cloud.points = {{5.1f, 0, 0}, {-1.5f, 0, 0}, {5.3f, 0, 0}, {0.2f, 0, 0}};
  const PointCloud thin = voxel_downsample(cloud, 1.0f);
  ASSERT_EQ(thin.size(), 3u);
  EXPECT_FLOAT_EQ(thin.points[0].x(), 5.2f);
  EXPECT_FLOAT_EQ(thin.points[1].x(), -1.5f);
  EXPECT_FLOAT_EQ(thin.points[2].x(), 0.2f);
}

TEST(VoxelMerger, RefusesAndCountsWhatHasNoVoxel) {
  PointCloud cloud;
  cloud.points = {{std::numeric_limits<float>::quiet_NaN(), 0, 0},
                  {0, std::numeric_limits<float>::infinity(), 0},
                  {0, 0, std::numeric_limits<float>::max()},
                  {3e6f, 0, 0},
                  {2e6f, -2e6f, 2e6f},
                  {1, 1, 1}};
  VoxelMerger merger(0.001f);
  EXPECT_EQ(merger.add(cloud), 2u);
  EXPECT_EQ(merger.refused(), 4u);
  EXPECT_EQ(merger.cloud().points[0], Eigen::Vector3f(2e6f, -2e6f, 2e6f));
}

TEST(VoxelMerger, MergingPiecewiseEqualsMergingAtOnce) {
  const PointCloud whole = street_scene(9'000, 2);
  for (const auto keep : {VoxelPoint::first, VoxelPoint::centroid}) {
    VoxelMerger at_once(0.3f, keep);
    at_once.add(whole);
    VoxelMerger piecewise(0.3f, keep);
    std::size_t added = 0;
    for (std::size_t start = 0; start < whole.size(); start += 1000) {
      PointCloud piece;
      const auto first = static_cast<std::ptrdiff_t>(start);
      piece.points.assign(whole.points.begin() + first, whole.points.begin() + first + 1000);
      piece.intensities.assign(whole.intensities.begin() + first, whole.intensities.begin() + first + 1000);
      added += piecewise.add(piece);
    }
    EXPECT_EQ(piecewise.cloud().points, at_once.cloud().points);
    EXPECT_EQ(added, at_once.voxels());
  }
}

TEST(VoxelMerger, FirstPointsStayWhereTheyWere) {
  const PointCloud a = street_scene(3'000, 3);
  VoxelMerger merger(0.3f, VoxelPoint::first);
  merger.add(a);
  const auto before = merger.cloud();
  EXPECT_EQ(merger.add(a), 0u);
  merger.add(street_scene(3'000, 4));
  const auto after = merger.cloud();
  ASSERT_GT(after.size(), before.size());
  EXPECT_TRUE(std::equal(before.points.begin(), before.points.end(), after.points.begin()));
}

TEST(VoxelMerger, IntensitiesSurviveOnlyIfAllCloudsHaveThem) {
  PointCloud with = street_scene(10, 5);
  PointCloud without = street_scene(10, 6);
  without.intensities.clear();
  VoxelMerger merger(0.01f);
  merger.add(with);
  EXPECT_TRUE(merger.cloud().has_intensities());
  merger.add(PointCloud{});
  EXPECT_TRUE(merger.cloud().has_intensities());
  merger.add(without);
  EXPECT_FALSE(merger.cloud().has_intensities());
}

TEST(VoxelMerger, WithoutAVoxelEveryFinitePointStays) {
  for (const float voxel : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(voxel_downsample(street_scene(100, 7), voxel).size(), 100u);
  }
}

}  // namespace
}  // namespace fleetmap::cloud
