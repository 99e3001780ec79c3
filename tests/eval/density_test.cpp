#include "fleetmap/eval/density.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/points.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::Points;
using ::testing::ElementsAre;

TEST(DensityAt, CountsPointsUpToTheRadiusAndTheQueryItself) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 0, 1.001f}, {2, 0, 0}};
  EXPECT_THAT(density_at(points, points, 1.0f), ElementsAre(3, 3, 2, 1, 2)) << "the radius itself is within";
  EXPECT_THAT(density_at({{0.5f, 0, 0}, {9, 9, 9}}, points, 0.6f), ElementsAre(2, 0));
}

TEST(DensityAt, EachOfEqualPointsCounts) {
  const Points points(7, Eigen::Vector3f(-3.5f, 2.0f, 0.0f));
  EXPECT_THAT(density_at({points[0], points[0]}, points, 0.1f), ElementsAre(7, 7));
}

TEST(DensityAt, NeighboursLieOnBothSidesOfZero) {
  // Cells are cubes of the radius; a query near a corner has neighbours in all eight around it.
  Points points;
  for (const float x : {-0.3f, 0.3f})
    for (const float y : {-0.3f, 0.3f})
      for (const float z : {-0.3f, 0.3f}) points.emplace_back(x, y, z);
  for (const Eigen::Vector3f& query :
       {Eigen::Vector3f(0.01f, 0.01f, 0.01f), Eigen::Vector3f(-0.01f, 0.01f, -0.01f)})
    EXPECT_THAT(density_at({query}, points, 1.0f), ElementsAre(8));
}

TEST(DensityAt, EqualsThePlainCountForQueriesBesideThePoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-4.0f, 4.0f);
  Points points, queries;
  for (int k = 0; k < 800; ++k) points.emplace_back(place(random), place(random), place(random));
  for (int k = 0; k < 200; ++k) queries.emplace_back(place(random), place(random), place(random));
  for (const float radius : {0.3f, 1.7f, 20.0f}) {
    const auto counts = density_at(queries, points, radius);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      std::uint32_t expected = 0;
      for (const auto& p : points) expected += (p - queries[i]).squaredNorm() <= radius * radius ? 1u : 0u;
      EXPECT_EQ(counts[i], expected) << radius;
    }
  }
}

TEST(DensityAt, NonFinitePointsCountNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Points points{{0, 0, 0}, {nan, 0, 0}, {0, inf, 0}};
  EXPECT_THAT(density_at(points, points, 1.0f), ElementsAre(1, 0, 0));
  for (const float radius : {0.0f, -1.0f, nan, inf})
    EXPECT_THAT(density_at({points[0]}, points, radius), ElementsAre(0)) << radius;
  EXPECT_TRUE(density_at({}, points, 1.0f).empty());
  EXPECT_THAT(density_at({points[0]}, {}, 1.0f), ElementsAre(0));
}

}  // namespace
}  // namespace fleetmap::eval
