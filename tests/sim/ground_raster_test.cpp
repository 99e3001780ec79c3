#include "sim/ground_raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kStepHeight = 0.15;

Grid grid(double cell = 0.25, int columns = 40, int rows = 40) { return {{0, 0}, cell, columns, rows}; }
Eigen::Vector2d center(const Grid& grid, int column, int row) {
  return grid.low + grid.cell * Eigen::Vector2d(column + 0.5, row + 0.5);
}
Mesh level(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double z = 0.0) {
  return test_ground(low, high, [z](double, double) { return z; });
}
float height_at(const GroundRaster& ground, const Grid& grid, double x, double y) {
  return ground.heights[grid.index(static_cast<int>((x - grid.low.x()) / grid.cell),
                                   static_cast<int>((y - grid.low.y()) / grid.cell))];
}
bool blocked_at(const Mesh& mesh, const Grid& grid, double x, double y, const DrivableConfig& config = {}) {
  const auto blocked = obstacle_raster(mesh, grid, ground_raster(mesh, grid, config.step_height), config);
  return blocked[grid.index(static_cast<int>((x - grid.low.x()) / grid.cell),
                            static_cast<int>((y - grid.low.y()) / grid.cell))] != 0;
}

TEST(GroundRaster, HoldsTheHeightAtTheCentreOfEachCell) {
  const auto plane = [](double x, double y) { return 3.0 + 0.2 * x - 0.1 * y; };
  const Mesh mesh = test_ground({-1, -1}, {11, 11}, plane);
  const Grid g = grid();
  const GroundRaster ground = ground_raster(mesh, g, kStepHeight);
  ASSERT_EQ(ground.heights.size(), 1600u);
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      const Eigen::Vector2d p = center(g, column, row);
      ASSERT_NEAR(static_cast<double>(ground.heights[g.index(column, row)]), plane(p.x(), p.y()), 1e-5);
      ASSERT_EQ(ground.gap[g.index(column, row)], 0);
    }
  }
}

TEST(GroundRaster, IsTheLowestSurfaceWithWhatLiesOnItUpToAStep) {
  Mesh mesh = level({-1, -1}, {11, 11});
  append(mesh, test_box({1, 1, 0.0}, {2, 2, 0.1}));  // a board
  append(mesh, test_box({4, 4, 0.0}, {5, 5, 0.3}));  // a block: too high
  append(mesh, test_box({7, 7, 2.0}, {8, 8, 2.1}));  // a roof
  const Grid g = grid();
  const GroundRaster ground = ground_raster(mesh, g, kStepHeight);
  EXPECT_NEAR(height_at(ground, g, 1.4, 1.6), 0.1f, 1e-6f);
  EXPECT_NEAR(height_at(ground, g, 4.4, 4.6), 0.0f, 1e-6f);
  EXPECT_NEAR(height_at(ground, g, 7.4, 7.6), 0.0f, 1e-6f);
  EXPECT_NEAR(height_at(ground, g, 9.1, 0.3), 0.0f, 1e-6f);
}

TEST(GroundRaster, HolesTakeTheHeightAroundThemAndCountTheStepsToIt) {
  Mesh mesh = level({-1, -1}, {4, 11}, 1.0);
  append(mesh, level({6, -1}, {11, 11}, 2.0));
  const Grid g = grid();  // columns 16 to 23 have no ground
  const GroundRaster ground = ground_raster(mesh, g, kStepHeight);
  const int expected[] = {0, 1, 2, 3, 4, 4, 3, 2, 1, 0};
  for (int k = 0; k < 10; ++k) EXPECT_EQ(ground.gap[g.index(15 + k, 20)], expected[k]) << k;
  EXPECT_EQ(ground.heights[g.index(18, 20)], 1.0f);
  EXPECT_EQ(ground.heights[g.index(21, 20)], 2.0f);
}

TEST(GroundRaster, FarFromAnyGroundTheCountIsSaturated) {
  const Mesh mesh = level({-1, -1}, {1, 1}, 5.0);
  const Grid g = grid(0.25, 400, 3);
  const GroundRaster ground = ground_raster(mesh, g, kStepHeight);
  EXPECT_EQ(ground.gap[g.index(3, 0)], 0);
  EXPECT_EQ(ground.gap[g.index(104, 0)], 101);
  EXPECT_EQ(ground.gap[g.index(399, 0)], 255);
  EXPECT_EQ(ground.heights[g.index(399, 2)], 5.0f);
}

TEST(GroundRaster, AMeshOfWallsAloneHasNone) {
  Mesh mesh;
  mesh.vertices = {{1, 1, 0}, {9, 9, 0}, {9, 9, 3}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {Material::kConcrete};
  const GroundRaster ground = ground_raster(mesh, grid(), kStepHeight);
  EXPECT_TRUE(std::ranges::all_of(ground.heights, [](float z) { return z == 0.0f; }));
  mesh.vertices = {{1, 1, 0}, {1, 1, 0}, {9, 9, 3}};
  EXPECT_TRUE(std::ranges::all_of(ground_raster(mesh, grid(), kStepHeight).heights, [](float z) {
    return z == 0.0f;
  })) << "nor has one without an area";
}

TEST(ObstacleRaster, IsWhatStandsBetweenAStepAndTheRobotsHeight) {
  const Mesh flat = level({-1, -1}, {11, 11});
  const auto with_slab = [&](double low, double high) {
    Mesh mesh = flat;
    append(mesh, test_box({3, 3, low}, {6, 6, high}));
    return mesh;
  };
  EXPECT_FALSE(blocked_at(flat, grid(), 4.6, 4.6));
  EXPECT_FALSE(blocked_at(with_slab(-0.1, 0.1), grid(), 4.6, 4.6)) << "driven over";
  EXPECT_TRUE(blocked_at(with_slab(0.5, 0.6), grid(), 4.6, 4.6));
  EXPECT_TRUE(blocked_at(with_slab(0.85, 3.0), grid(), 4.6, 4.6));
  EXPECT_FALSE(blocked_at(with_slab(0.95, 3.0), grid(), 4.6, 4.6)) << "driven under";
  EXPECT_FALSE(blocked_at(with_slab(0.5, 0.6), grid(), 6.3, 4.6)) << "beside it";
}

TEST(ObstacleRaster, AThinPostBlocksTheCellThatItStandsIn) {
  Mesh mesh = level({-1, -1}, {11, 11});
  append(mesh, test_box({5.02, 5.02, -0.5}, {5.04, 5.04, 2}));  // no cell's centre is in it
  const Grid g = grid();
  const auto blocked = obstacle_raster(mesh, g, ground_raster(mesh, g, kStepHeight), {});
  EXPECT_EQ(std::ranges::count(blocked, 1), 1);
  EXPECT_EQ(blocked[g.index(20, 20)], 1);
}

TEST(ObstacleRaster, AWireAcrossBlocksEachCellThatItCrosses) {
  Mesh mesh = level({-1, -1}, {11, 11});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& v : {Eigen::Vector3f(1.1f, 1.1f, 0.5f), Eigen::Vector3f(8.9f, 4.9f, 0.5f),
                                   Eigen::Vector3f(8.9f, 4.9f, 0.51f)})
    mesh.vertices.push_back(v);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.materials.push_back(Material::kMetal);
  const Grid g = grid();
  const auto blocked = obstacle_raster(mesh, g, ground_raster(mesh, g, kStepHeight), {});
  std::set<std::size_t> crossed;
  for (double part = 0.0; part <= 1.0; part += 1e-4) {
    const Eigen::Vector2d p = Eigen::Vector2d(1.1, 1.1) + part * Eigen::Vector2d(7.8, 3.8);
    crossed.insert(g.index(static_cast<int>(p.x() / g.cell), static_cast<int>(p.y() / g.cell)));
  }
  for (const std::size_t cell : crossed) EXPECT_EQ(blocked[cell], 1);
  EXPECT_LE(std::ranges::count(blocked, 1), std::ssize(crossed) + 1) << "and hardly any other";
}

TEST(ObstacleRaster, SteepGroundIsInTheWayUnlessItIsAMereStep) {
  const auto slope = [](double tangent) {
    return test_ground({-1, -1}, {11, 11}, [=](double x, double) { return tangent * x; });
  };
  EXPECT_FALSE(blocked_at(slope(0.4), grid(), 5.1, 5.1)) << "21.8 deg";
  EXPECT_TRUE(blocked_at(slope(0.6), grid(), 5.1, 5.1)) << "31 deg";
  DrivableConfig config;
  config.max_slope_rad = 0.6;
  EXPECT_FALSE(blocked_at(slope(0.6), grid(), 5.1, 5.1, config));
  Mesh kerb = level({-1, -1}, {5, 11});
  append(kerb, level({5, -1}, {11, 11}, 0.12));
  EXPECT_FALSE(blocked_at(kerb, grid(), 4.9, 5.1));
  EXPECT_FALSE(blocked_at(kerb, grid(), 5.1, 5.1));
  Mesh ledge = level({-1, -1}, {5, 11});
  append(ledge, level({5, -1}, {11, 11}, 0.5));
  EXPECT_TRUE(blocked_at(ledge, grid(), 4.9, 5.1));
}

TEST(ObstacleRaster, HolesAreBridgedHalfAMetreFromSolidGround) {
  Mesh mesh = level({-1, -1}, {4, 11});
  append(mesh, level({6, -1}, {11, 11}));
  const Grid g = grid();
  const auto blocked = obstacle_raster(mesh, g, ground_raster(mesh, g, kStepHeight), {});
  const int expected[] = {0, 0, 0, 1, 1, 1, 1, 0, 0, 0};
  for (int k = 0; k < 10; ++k) EXPECT_EQ(blocked[g.index(15 + k, 20)], expected[k]) << k;
}

}  // namespace
}  // namespace fleetmap::sim
