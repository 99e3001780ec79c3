#include "registration/correlation_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "support/points.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using fleetmap::testing::Points;

/// Level ground of 20 m x 20 m around the origin at height 1.
Points ground() {
  Points points;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y)
      points.emplace_back(0.5f * static_cast<float>(x), 0.5f * static_cast<float>(y), 1.0f);
  }
  return points;
}

/// Value of the cell that lies so many cells from `p`.
int layer_at(const CorrelationGrid& map, const Vector2f& p, int layer, int dx = 0, int dy = 0) {
  const Eigen::Vector2i c = ((p - map.origin) / map.cell_m).cast<int>() + Eigen::Vector2i(dx, dy);
  return map.layers[static_cast<std::size_t>((layer * map.size.y() + c.y()) * map.size.x() + c.x())];
}

bool observed_at(const CorrelationGrid& map, const Vector2f& p) {
  const Eigen::Vector2i c = ((p - map.origin) / (map.cell_m * kObservedCells)).cast<int>();
  return map.observed[static_cast<std::size_t>(c.y() * map.observed_size.x() + c.x())] != 0;
}

TEST(CorrelationGrid, EmptyInputGivesEmptyOutput) {
  const CorrelationGrid map = correlation_grid({}, {});
  EXPECT_TRUE(map.layers.empty());
  EXPECT_TRUE(map.cells.empty());
  EXPECT_TRUE(std::isnan(map.floor.at({0, 0})));
}

TEST(CorrelationGrid, TheFloorIsTheLowestPointAround) {
  Points points = ground();
  points.emplace_back(5.0f, 5.0f, 0.5f);   // a hole
  points.emplace_back(-5.0f, 0.0f, 4.0f);  // a twig
  const Floor floor = correlation_grid(points, {}).floor;
  EXPECT_EQ(floor.at({-5, 0}), 1.0f);
  EXPECT_EQ(floor.at({5, 5}), 0.5f);
  EXPECT_EQ(floor.at({7, 5}), 0.5f);
  EXPECT_EQ(floor.at({1, 5}), 1.0f);
  EXPECT_TRUE(std::isnan(floor.at({100, 0})));
  EXPECT_TRUE(std::isnan(floor.at({0, -100})));
}

TEST(CorrelationGrid, APointIsInTheLayerOfItsHeightAboveTheFloor) {
  const CorrelationGridConfig config;
  for (const auto& [height, layer] : std::vector<std::pair<float, int>>{{0.36f, 0},
                                                                        {0.35f + 0.3f, 0},
                                                                        {0.35f + 0.9f, 1},
                                                                        {0.35f + 3.9f, 6},
                                                                        {0.35f + 4.5f, 7},
                                                                        {30.0f, 7}}) {
    Points points = ground();
    points.emplace_back(3.3f, 2.2f, 1.0f + height);
    const CorrelationGrid map = correlation_grid(points, config);
    ASSERT_EQ(map.cells.size(), 1u) << height;
    EXPECT_EQ(map.cells[0].layer, layer) << height;
    EXPECT_EQ(map.cells[0].center, Vector2f(3.3f, 2.2f));
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, layer), 2);
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, layer, 1, -1), 1) << "next to it";
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, layer, 2, 0), 0);
    EXPECT_EQ(std::accumulate(map.layers.begin(), map.layers.end(), 0), 2 + 8) << "in no other layer";
  }
  Points low = ground();
  low.emplace_back(3.3f, 2.2f, 1.34f);
  EXPECT_TRUE(correlation_grid(low, config).cells.empty()) << "that is floor";
}

/// Heights of two clouds differ a little, so what lies near the border of two layers is in both.
TEST(CorrelationGrid, NearABorderBothLayersAreOccupied) {
  for (const auto& [height, layer] : std::vector<std::pair<float, int>>{{0.58f, 0}, {0.62f, 1}}) {
    Points points = ground();
    points.emplace_back(3.3f, 2.2f, 1.0f + 0.35f + height);
    const CorrelationGrid map = correlation_grid(points, {});
    ASSERT_EQ(map.cells.size(), 1u);
    EXPECT_EQ(map.cells[0].layer, layer);
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, 0), 2) << height;
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, 1), 2) << height;
    EXPECT_EQ(layer_at(map, {3.3f, 2.2f}, 2), 0) << height;
  }
}

TEST(CorrelationGrid, CellsWithAnyPointAreObserved) {
  Points points = ground();
  points.emplace_back(40.0f, 0.0f, 1.0f);
  const CorrelationGrid map = correlation_grid(points, {});
  EXPECT_TRUE(observed_at(map, {0, 0}));
  EXPECT_TRUE(observed_at(map, {-9.5f, 9.5f}));
  EXPECT_FALSE(observed_at(map, {25, 0}));
  EXPECT_TRUE(observed_at(map, {40, 0}));
  EXPECT_FALSE(observed_at(map, {39, 9}));
}

TEST(CorrelationGrid, CellsArePickedEvenly) {
  Points points = ground();
  for (int k = 0; k < 24; ++k) points.emplace_back(-9.0f + 0.6f * static_cast<float>(k) + 0.3f, 0.3f, 2.0f);
  CorrelationGridConfig config;
  ASSERT_EQ(correlation_grid(points, config).cells.size(), 24u);
  config.max_cells = 6;
  const CorrelationGrid map = correlation_grid(points, config);
  ASSERT_EQ(map.cells.size(), 6u);
  for (std::size_t k = 1; k < 6; ++k)
    EXPECT_NEAR(map.cells[k].center.x() - map.cells[k - 1].center.x(), 4 * 0.6f, 1e-4f);
}

TEST(CorrelationGrid, TheHeightOfTheWholeDoesNotMatter) {
  Points points = ground();
  for (int k = 0; k < 60; ++k) {
    const auto v = static_cast<float>(k);
    points.emplace_back(9.0f * std::sin(v), 9.0f * std::cos(2.0f * v), 1.5f + 0.0625f * v);
  }
  const CorrelationGrid map = correlation_grid(points, {});
  for (Vector3f& p : points) p.z() += 8.0f;
  const CorrelationGrid higher = correlation_grid(points, {});
  EXPECT_GT(map.cells.size(), 30u);
  EXPECT_EQ(map.layers, higher.layers);
  EXPECT_EQ(map.observed, higher.observed);
  EXPECT_EQ(higher.floor.at({0, 0}), map.floor.at({0, 0}) + 8.0f);
}

}  // namespace
}  // namespace fleetmap::registration
