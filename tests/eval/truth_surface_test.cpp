#include "truth_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fleetmap::eval {
namespace {

/// A floor of 4 m x 4 m and a wall of the same size at its edge x = 0, sampled every 0.1 m.
cloud::PointCloud floor_and_wall() {
  cloud::PointCloud cloud;
  for (int a = 0; a <= 40; ++a) {
    for (int b = 0; b <= 40; ++b) {
      const float u = 0.1f * static_cast<float>(a), v = 0.1f * static_cast<float>(b);
      cloud.points.emplace_back(u, v, 0.0f);
      if (a > 0) cloud.points.emplace_back(0.0f, v, u);
    }
  }
  return cloud;
}

Foot foot_of(const TruthSurface& surface, const Eigen::Vector3f& point, float cap = 1.0f) {
  return surface.feet_of({point}, cap).at(0);
}

TEST(TruthSurface, ItsSpacingIsTheEdgeOfTheGrid) {
  EXPECT_NEAR(TruthSurface(floor_and_wall()).spacing(), 0.1f, 1e-4f);
  EXPECT_EQ(TruthSurface({{{0, 0, 0}, {1, 0, 0}}, {}}).spacing(), 0.0f) << "there are no four neighbours";
}

TEST(TruthSurface, AFootIsThePointBelowOnThePlane) {
  const TruthSurface surface(floor_and_wall());
  // In the middle of a cell of the grid, 0.2 m above the floor.
  const Foot foot = foot_of(surface, {2.05f, 2.05f, 0.2f});
  ASSERT_TRUE(foot.found);
  EXPECT_NEAR(foot.point_distance, std::sqrt(0.2f * 0.2f + 2 * 0.05f * 0.05f), 1e-4f);
  EXPECT_NEAR(foot.surface_distance, 0.2f, 1e-4f) << "between the samples, the surface goes on";
  EXPECT_NEAR(std::abs(foot.normal.z()), 1.0f, 1e-4f);
  EXPECT_NEAR((surface.cloud().points[foot.truth] - Eigen::Vector3f(2.05f, 2.05f, 0)).norm(), 0.0707f, 1e-3f);
  EXPECT_NEAR(std::abs(foot_of(surface, {-0.3f, 2.0f, 2.0f}).normal.x()), 1.0f, 1e-4f) << "on the wall";
}

TEST(TruthSurface, BesideItsEdgeTheDistanceIsThatToTheDisc) {
  const TruthSurface surface(floor_and_wall());
  // 0.5 m beyond the floor's last point, whose disc reaches one spacing.
  const Foot foot = foot_of(surface, {4.5f, 2.0f, 0.0f});
  EXPECT_NEAR(foot.point_distance, 0.5f, 1e-4f);
  EXPECT_NEAR(foot.surface_distance, 0.4f, 1e-3f);
}

TEST(TruthSurface, AnEdgeHasNoNormalAndItsDistanceIsThatToThePoint) {
  const TruthSurface surface(floor_and_wall());
  const Foot foot = foot_of(surface, {0.01f, 2.0f, 0.01f});
  ASSERT_TRUE(foot.found);
  EXPECT_TRUE(foot.normal.isZero());
  EXPECT_EQ(foot.surface_distance, foot.point_distance);
  const auto normals = surface.normals_at({foot.truth});
  ASSERT_EQ(normals.size(), 1u);
  EXPECT_TRUE(normals[0].isZero());
}

TEST(TruthSurface, ABushHasNoNormals) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-0.5f, 0.5f);
  cloud::PointCloud bush;
  for (int k = 0; k < 500; ++k) bush.points.emplace_back(place(random), place(random), place(random));
  const TruthSurface surface(bush);
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < bush.size(); ++k) all.push_back(k);
  int flat = 0;
  for (const auto& normal : surface.normals_at(all)) flat += normal.isZero() ? 0 : 1;
  EXPECT_LT(flat, 25) << "12 neighbours lie on a plane by chance only";
}

TEST(TruthSurface, BeyondTheCapNothingIsFound) {
  const TruthSurface surface(floor_and_wall());
  const std::vector<Foot> feet =
      surface.feet_of({{2, 2, -0.49f}, {2, 2, -0.51f}, {NAN, 0, 0}, {2, 2, 0}}, 0.5f);
  EXPECT_TRUE(feet[0].found);
  EXPECT_FALSE(feet[1].found);
  EXPECT_FALSE(feet[2].found);
  EXPECT_TRUE(feet[3].found);
  EXPECT_EQ(feet[3].surface_distance, 0.0f);
  EXPECT_TRUE(surface.feet_of({}, 0.5f).empty());
}

}  // namespace
}  // namespace fleetmap::eval
