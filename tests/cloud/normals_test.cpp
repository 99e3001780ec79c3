#include "fleetmap/cloud/normals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace fleetmap::cloud {
namespace {

/// Ends of three axes of these half lengths: the covariance is diagonal, of squares over 3.
PointCloud octahedron(const Eigen::Vector3f& half, const Eigen::Vector3f& middle) {
  PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f})
      cloud.points.emplace_back(middle + sign * half[axis] * Eigen::Vector3f::Unit(axis));
  }
  return cloud;
}

/// Points of a level, oblong grid of `count` x `count` points.
PointCloud level_grid(int count) {
  PointCloud cloud;
  for (int x = 0; x < count; ++x) {
    for (int y = 0; y < count; ++y)
      cloud.points.emplace_back(0.1f * static_cast<float>(x), 0.15f * static_cast<float>(y), 0.0f);
  }
  return cloud;
}

Normals normals_of(const PointCloud& cloud, const NormalConfig& config) {
  return estimate_normals(cloud, KdTree(cloud), config);
}

TEST(NormalsOf, AreTheShortestAxisAndItsShareOfTheSpread) {
  const std::array<Eigen::Vector3f, 3> halves{{{1.0f, 0.8f, 0.2f}, {0.2f, 1.0f, 0.8f}, {0.8f, 0.2f, 1.0f}}};
  const std::array<int, 3> shortest{2, 0, 1};
  NormalConfig config;
  config.neighbors = 6;
  config.max_radius_m = 10.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    const PointCloud cloud = octahedron(halves[k], {2000.0f, -1000.0f, 500.0f});
    const Normals normals = normals_of(cloud, config);
    for (const std::size_t i : {0u, 3u, 5u}) {
      EXPECT_NEAR(std::abs(normals.normals[i][shortest[k]]), 1.0f, 1e-4f) << k;
      EXPECT_NEAR(normals.variations[i], 0.04f / (1.0f + 0.64f + 0.04f), 1e-4f) << k;
    }
  }
}

TEST(NormalsOf, PointToTheViewpointOnEitherSide) {
  const PointCloud cloud = level_grid(4);
  for (const float height : {-7.0f, 7.0f}) {
    NormalConfig config;
    config.viewpoint = {100.0f, -50.0f, height};
    for (const Eigen::Vector3f& normal : normals_of(cloud, config).normals)
      EXPECT_LT((normal - Eigen::Vector3f(0.0f, 0.0f, height / 7.0f)).norm(), 1e-4f);
  }
}

TEST(NormalsOf, NeighboursBeyondTheRadiusDoNotCount) {
  PointCloud cloud = level_grid(3);
  for (int k = 0; k < 6; ++k) cloud.points.emplace_back(1.2f, 0.1f, 0.3f * static_cast<float>(k));
  NormalConfig config;
  config.max_radius_m = 0.6f;
  const Normals near = estimate_normals(cloud, KdTree(cloud), config, {4});
  EXPECT_NEAR(std::abs(near.normals[0].z()), 1.0f, 1e-5f);
  EXPECT_NEAR(near.variations[0], 0.0f, 1e-6f);
  config.max_radius_m = 3.0f;
  const Normals all = estimate_normals(cloud, KdTree(cloud), config, {4});
  EXPECT_LT(std::abs(all.normals[0].z()), 0.9f) << "with the pole beside it the spread is another";
}

TEST(NormalsOf, NeedAsManyNeighboursAsTheConfigurationSays) {
  const PointCloud cloud = level_grid(2);
  NormalConfig config;
  config.min_neighbors = 5;
  const Normals none = normals_of(cloud, config);
  EXPECT_TRUE(none.normals[0].isZero());
  EXPECT_EQ(none.variations[0], 1.0f);
  config.min_neighbors = 4;
  EXPECT_NEAR(std::abs(normals_of(cloud, config).normals[0].z()), 1.0f, 1e-5f);
}

TEST(NormalsOf, AnEmptyCloudOrNoIndicesAreNone) {
  EXPECT_TRUE(normals_of(PointCloud{}, {}).normals.empty());
  const PointCloud cloud = level_grid(4);
  EXPECT_TRUE(estimate_normals(cloud, KdTree(cloud), {}, {}).variations.empty());
}

}  // namespace
}  // namespace fleetmap::cloud
