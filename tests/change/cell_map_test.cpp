#include "cell_map.hpp"

#include <gtest/gtest.h>

namespace fleetmap::change {
namespace {

ObservedSubmap submap(std::vector<Eigen::Vector3f> points) { return {{std::move(points), {}}, {}}; }

TEST(CellMap, CountsTheSubmapsAndNotThePointsOfACell) {
  const ObservedSubmap a = submap({{0.05f, 0.05f, 0.0f}, {0.15f, 0.05f, 0.0f}, {1.0f, 0.0f, 0.0f}});
  const ObservedSubmap b = submap({{0.1f, 0.15f, 0.0f}});
  const CellMap map({&a, &b}, 0.2);
  ASSERT_EQ(map.cells().size(), 2u);
  EXPECT_EQ(map.cells()[0].submaps, 2u);
  EXPECT_LT((map.cells()[0].centre - Eigen::Vector3f(0.1f, 0.1f, 0.0f)).norm(), 1e-5f);
  EXPECT_EQ(map.cells()[1].submaps, 1u);
}

TEST(CellMap, MeasuresTheDistanceUpToTheReach) {
  const ObservedSubmap a = submap({{0.0f, 0.0f, 0.0f}});
  const CellMap map({&a}, 0.2);
  EXPECT_FLOAT_EQ(map.distance({0.0f, 0.3f, 0.4f}, 3.0f), 0.5f);
  EXPECT_FLOAT_EQ(map.distance({0.0f, 30.0f, 0.0f}, 3.0f), 3.0f);
  EXPECT_FLOAT_EQ(CellMap({}, 0.2).distance({0.0f, 0.0f, 0.0f}, 3.0f), 3.0f);
}

TEST(CellMap, KnowsSurfacesOfTheSameHeightNearby) {
  const ObservedSubmap a = submap({{0.0f, 0.0f, 0.0f}});
  const CellMap map({&a}, 0.2);
  EXPECT_TRUE(map.has_level({1.0f, 0.0f, 0.2f}, 1.5f, 0.25f));
  EXPECT_FALSE(map.has_level({1.0f, 0.0f, 0.4f}, 1.5f, 0.25f));
  EXPECT_FALSE(map.has_level({2.0f, 0.0f, 0.2f}, 1.5f, 0.25f));
}

}  // namespace
}  // namespace fleetmap::change
