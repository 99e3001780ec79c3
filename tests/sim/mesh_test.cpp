#include "fleetmap/sim/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::sim {
namespace {

/// Two triangles: 1 m^2 of ground around the origin, 3 m^2 of wall at x = 10.
Mesh unequal_pair() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {10, 0, 0}, {10, 3, 0}, {10, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.materials = {Material::kGround, Material::kConcrete};
  return mesh;
}

TEST(Mesh, AppendShiftsIndices) {
  Mesh mesh = unequal_pair();
  append(mesh, unequal_pair());
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.triangles[3], (std::array<std::uint32_t, 3>{9, 10, 11}));
  EXPECT_EQ(mesh.materials[3], Material::kConcrete);
  EXPECT_DOUBLE_EQ(area(mesh), 8.0);
}

TEST(SampleSurface, GivesEveryTriangleItsShare) {
  const auto cloud = sample_surface(unequal_pair(), 1000.0, 5);
  EXPECT_NEAR(static_cast<double>(cloud.size()), 4000.0, 1.0);
  std::size_t on_ground = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : cloud.points) {
    if (p.x() > 5.0f) continue;
    ++on_ground;
    mean += p.cast<double>();
    EXPECT_FLOAT_EQ(p.z(), 0.0f);
    EXPECT_LE(p.x() / 2.0f + p.y(), 1.0f + 1e-5f);
  }
  EXPECT_NEAR(static_cast<double>(on_ground), 1000.0, 1.0);
  mean /= static_cast<double>(on_ground);
  EXPECT_NEAR(mean.x(), 2.0 / 3.0, 0.06);
  EXPECT_NEAR(mean.y(), 1.0 / 3.0, 0.03);
}

TEST(SampleSurface, SameSeedSamePointsAndAnotherSeedOthers) {
  const Mesh mesh = unequal_pair();
  EXPECT_EQ(sample_surface(mesh, 50.0, 1).points, sample_surface(mesh, 50.0, 1).points);
  EXPECT_NE(sample_surface(mesh, 50.0, 1).points, sample_surface(mesh, 50.0, 2).points);
}

TEST(SampleSurface, KeepsToItsLimits) {
  const Mesh mesh = unequal_pair();
  EXPECT_NEAR(static_cast<double>(sample_surface(mesh, 1e9, 1, 100).size()), 100.0, 1.0);
  EXPECT_LE(sample_surface(mesh, 1e9, 1, 100).size(), 100u);
  EXPECT_TRUE(sample_surface(mesh, 0.0, 1).empty());
  EXPECT_TRUE(sample_surface(mesh, std::nan(""), 1).empty());
  EXPECT_TRUE(sample_surface(Mesh{}, 10.0, 1).empty());
}

}  // namespace
}  // namespace fleetmap::sim
