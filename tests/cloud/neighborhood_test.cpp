#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/outliers.hpp"

namespace fleetmap::cloud {
namespace {

PointCloud plane(std::size_t count, const Eigen::Vector3f& normal, float noise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-5.0f, 5.0f);
  std::normal_distribution<float> gauss(0.0f, noise);
  const Eigen::Vector3f a = normal.unitOrthogonal();
  const Eigen::Vector3f b = normal.cross(a);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(unit(random) * a + unit(random) * b + (10.0f + gauss(random)) * normal);
  }
  return cloud;
}

TEST(Normals, NormalsOfAPlaneFaceTheViewpointWithLittleVariation) {
  const Eigen::Vector3f n = Eigen::Vector3f(1, 2, -3).normalized();
  const PointCloud cloud = plane(2000, n, 0.005f);
  const Normals normals = estimate_normals(cloud, KdTree(cloud), {});
  double error = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(normals.normals[i].norm(), 1.0f, 1e-4f);
    ASSERT_LT(normals.normals[i].dot(cloud.points[i]), 0.0f);
    EXPECT_LT(normals.variations[i], 0.05f);
    error += std::acos(std::min(1.0f, std::abs(normals.normals[i].dot(n))));
  }
  EXPECT_LT(error / static_cast<double>(cloud.size()), 0.03);
}

TEST(Normals, LinesSpotsAndLonelyPointsHaveNone) {
  PointCloud cloud;
  for (int i = 0; i < 50; ++i) cloud.points.emplace_back(0.1f * static_cast<float>(i), 0.0f, 1.0f);
  for (int i = 0; i < 20; ++i) cloud.points.emplace_back(100.0f, 100.0f, 100.0f);
  cloud.points.emplace_back(500.0f, 0.0f, 0.0f);
  const Normals normals = estimate_normals(cloud, KdTree(cloud), {});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_TRUE(normals.normals[i].isZero()) << i;
    EXPECT_EQ(normals.variations[i], 1.0f);
  }
}

TEST(Normals, NormalsOfSomePointsEqualThoseOfAll) {
  const PointCloud cloud = testing::street_scene(2000, 3);
  const KdTree tree(cloud);
  const Normals all = estimate_normals(cloud, tree, {});
  const Normals some = estimate_normals(cloud, tree, {}, {5, 1999, 42});
  EXPECT_EQ(some.normals[0], all.normals[5]);
  EXPECT_EQ(some.normals[1], all.normals[1999]);
  EXPECT_EQ(some.variations[2], all.variations[42]);
}

TEST(Outliers, StrayPointsGoAndSurfacesStay) {
  PointCloud cloud = plane(4000, Eigen::Vector3f::UnitZ(), 0.01f);
  const std::size_t surface = cloud.size();
  for (int i = 0; i < 20; ++i) cloud.points.emplace_back(-20.0f + 2.0f * static_cast<float>(i), 30.0f, 3.0f);
  cloud.points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
  const OutlierSplit split = split_outliers(cloud, {});
  EXPECT_EQ(split.kept.size() + split.removed.size(), cloud.size());
  EXPECT_GT(split.kept.size(), surface * 97 / 100);
  EXPECT_LT(split.kept.back(), surface);
}

/// Law: what the definition says, whatever the order of the points.
TEST(Outliers, AreThoseOfBruteForceInAnyOrder) {
  std::mt19937 random(3);
  std::normal_distribution<float> along(0.0f, 5.0f);
  PointCloud cloud;
  for (int i = 0; i < 600; ++i)
    cloud.points.emplace_back(along(random), along(random), 0.05f * along(random));
  const OutlierConfig config;
  std::vector<double> means;
  for (const auto& p : cloud.points) {
    std::vector<double> distances;
    for (const auto& q : cloud.points) distances.push_back(static_cast<double>((p - q).norm()));
    std::sort(distances.begin(), distances.end());
    const auto last = distances.begin() + 1 + static_cast<std::ptrdiff_t>(config.neighbors);
    means.push_back(std::accumulate(distances.begin() + 1, last, 0.0) /
                    static_cast<double>(config.neighbors));
  }
  const auto count = static_cast<double>(means.size());
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / count;
  double squares = 0.0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double limit = mean + config.sigmas * std::sqrt(squares / (count - 1.0));
  std::vector<std::size_t> expected;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i] > limit) expected.push_back(i);
  }
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(split_outliers(cloud, config).removed, expected);
}

TEST(Outliers, EmptyAndSinglePointsAreHarmless) {
  EXPECT_TRUE(split_outliers(PointCloud{}, {}).kept.empty());
  PointCloud one;
  one.points.emplace_back(1.0f, 2.0f, 3.0f);
  EXPECT_EQ(split_outliers(one, {}).kept.size(), 1u);
}

TEST(PointCloud, TransformSelectAppendKeepIntensitiesInStep) {
  const PointCloud cloud = testing::street_scene(100, 4);
  const Pose T = make_pose(rotation_from_rpy(0.1, 0.2, 0.3), Eigen::Vector3d(1, 2, 3));
  const PointCloud back = transformed(transformed(cloud, T), T.inverse());
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_LT((back.points[i] - cloud.points[i]).norm(), 1e-4f);
  PointCloud joined = select(cloud, {3, 1});
  EXPECT_EQ(joined.intensities[0], cloud.intensities[3]);
  append(joined, cloud);
  EXPECT_EQ(joined.intensities.size(), 102u);
  PointCloud bare = cloud;
  bare.intensities.clear();
  append(joined, bare);
  EXPECT_EQ(joined.size(), 202u);
  EXPECT_FALSE(joined.has_intensities());
  joined.points[7].x() = std::numeric_limits<float>::infinity();
  EXPECT_EQ(remove_non_finite(joined), 1u);
  EXPECT_EQ(joined.size(), 201u);
}

}  // namespace
}  // namespace fleetmap::cloud
