#include "fleetmap/odometry/thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace fleetmap::odometry {
namespace {

using ::testing::ElementsAre;

std::vector<std::size_t> first_of(Thinning& thinning, const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::size_t> first;
  thinning.for_each_first(
      points.size(), [&](std::size_t k) { return points[k]; }, [&](std::size_t k) { first.push_back(k); });
  return first;
}

TEST(Thinning, KeepsTheFirstPointOfEachCubeUntilItIsCleared) {
  Thinning thinning(0.5);
  EXPECT_TRUE(thinning.first_in_cube({0.1f, 0.1f, 0.1f}));
  EXPECT_FALSE(thinning.first_in_cube({0.4f, 0.4f, 0.4f}));
  EXPECT_TRUE(thinning.first_in_cube({-0.1f, 0.1f, 0.1f})) << "cubes are floored, not truncated";
  thinning.clear();
  EXPECT_TRUE(thinning.first_in_cube({0.4f, 0.4f, 0.4f}));
}

TEST(Thinning, CubesArePassedOnFromCallToCall) {
  Thinning thinning(1.0);
  const std::vector<Eigen::Vector3f> points{
      {0.5f, 0.5f, 0.5f}, {0.6f, 0.5f, 0.5f}, {1.5f, 0.5f, 0.5f}, {0.7f, 0.5f, 0.5f}};
  EXPECT_THAT(first_of(thinning, points), ElementsAre(0u, 2u));
  EXPECT_THAT(first_of(thinning, {{1.1f, 0.5f, 0.5f}, {2.5f, 0.5f, 0.5f}}), ElementsAre(1u));
}

/// More points than a block that is fetched ahead holds.
TEST(Thinning, AgreesWithAMapOfCubes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-4.0f, 4.0f);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 3000; ++k)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  std::map<std::array<int, 3>, std::size_t> cubes;
  std::vector<std::size_t> expected;
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::array<int, 3> cube{};
    for (int axis = 0; axis < 3; ++axis)
      cube[static_cast<std::size_t>(axis)] = static_cast<int>(std::floor(points[k][axis]));
    if (cubes.emplace(cube, k).second) expected.push_back(k);
  }
  Thinning thinning(1.0);
  EXPECT_EQ(first_of(thinning, points), expected);
}

}  // namespace
}  // namespace fleetmap::odometry
