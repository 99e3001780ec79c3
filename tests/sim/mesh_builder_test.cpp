#include "sim/mesh_builder.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace fleetmap::sim {
namespace {

using Point = MeshBuilder::Point;

const Eigen::Vector2d kEast(1.0, 0.0);

/// Volume by the divergence theorem; positive if all normals point outward.
double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::uint32_t k) { return Eigen::Vector3d(mesh.vertices[k].cast<double>()); };
    sum += at(a).dot(at(b).cross(at(c))) / 6.0;
  }
  return sum;
}

/// SideTest of triangles that no other triangle has the other way round.
int open_sides(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      from < to ? ++sides[{from, to}] : --sides[{to, from}];
    }
  }
  return static_cast<int>(std::ranges::count_if(sides, [](const auto& side) { return side.second != 0; }));
}

TEST(MeshBuilder, TurnsItsFrameIntoEnu) {
  Mesh mesh;
  MeshBuilder builder(mesh, {0.0, 1.0});  // u is north, so v is west
  EXPECT_EQ(builder.vertex({2.0, 0.0, 5.0}), 0u);
  EXPECT_EQ(builder.vertex({0.0, 3.0, 6.0}), 1u);
  EXPECT_TRUE(mesh.vertices[0].isApprox(Eigen::Vector3f(0, 2, 5)));
  EXPECT_TRUE(mesh.vertices[1].isApprox(Eigen::Vector3f(-3, 0, 6)));
}

TEST(MeshBuilder, AQuadIsTwoTrianglesOfItsMaterial) {
  Mesh mesh;
  MeshBuilder builder(mesh, kEast);
  builder.triangle(Point(0, 0, 9), Point(1, 0, 9), Point(0, 1, 9), Material::kGlass);
  builder.quad({0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, Material::kMetal);
  EXPECT_EQ(mesh.vertices.size(), 7u);
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.materials, (std::vector{Material::kGlass, Material::kMetal, Material::kMetal}));
  EXPECT_DOUBLE_EQ(area(mesh), 0.5 + 6.0);
}

TEST(MeshBuilder, ASlabIsClosedAndItsNormalsPointOutward) {
  Mesh mesh;
  MeshBuilder builder(mesh, Eigen::Vector2d(0.6, 0.8));
  builder.slab({Point(0, 0, 1), Point(4, 0, 1), Point(4, 2, 2), Point(0, 2, 2)}, {0, 0, 0.5},
               Material::kGlass);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(open_sides(mesh), 0);
  EXPECT_NEAR(volume(mesh), 4.0 * 2.0 * 0.5, 1e-5);
}

TEST(MeshBuilder, APostIsATubeOpenAtBothEnds) {
  Mesh mesh;
  MeshBuilder builder(mesh, kEast);
  builder.post({5, 6, 1}, 3.0, 0.5, 6, Material::kMetal);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(open_sides(mesh), 12);
  EXPECT_NEAR(area(mesh), 6 * 0.5 * 3.0, 1e-5) << "a hexagon's side is its radius";
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_NEAR((v.head<2>() - Eigen::Vector2f(5, 6)).norm(), 0.5f, 1e-6f);
    EXPECT_TRUE(v.z() == 1.0f || v.z() == 4.0f);
  }
}

TEST(MeshBuilder, ABeamIsSquareInEveryDirection) {
  for (const Point& to : {Point(4, 0, 0), Point(0, 0, 4), Point(1, -2, 3.2), Point(0.1, 0, 4)}) {
    Mesh mesh;
    MeshBuilder builder(mesh, kEast);
    builder.beam({0, 0, 0}, to, 0.2, Material::kMetal);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_NEAR(area(mesh), 4 * 0.2 * to.norm(), 1e-5);
    for (const Eigen::Vector3f& v : mesh.vertices) {
      const double along = v.cast<double>().dot(to.normalized());
      EXPECT_NEAR(std::min(along, to.norm() - along), 0.0, 1e-5);
      EXPECT_NEAR((v.cast<double>() - along * to.normalized()).norm(), 0.1 * std::numbers::sqrt2, 1e-6);
    }
  }
}

}  // namespace
}  // namespace fleetmap::sim
