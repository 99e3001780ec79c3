#include "thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "support/field_bounds.hpp"
#include "support/points.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::kNaN;
using fleetmap::testing::Points;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr float kInf = std::numeric_limits<float>::infinity();

Points scattered(std::size_t count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-20.0f, 20.0f);
  Points points;
  for (std::size_t k = 0; k < count; ++k) points.emplace_back(place(random), place(random), place(random));
  return points;
}

std::multiset<std::array<float, 3>> as_set(const Points& points) {
  std::multiset<std::array<float, 3>> all;
  for (const auto& p : points) all.insert({p.x(), p.y(), p.z()});
  return all;
}

TEST(Thinning, UsablePointsAreFiniteNearAndMoved) {
  const cloud::PointCloud cloud{{{1, 2, 3}, {kNaN<float>, 0, 0}, {0, 0, kInf}, {0, -1e6f, 0}, {4, 5, 6}}, {}};
  EXPECT_THAT(usable(cloud, {1, 1, 1}), ElementsAre(Eigen::Vector3f(0, 1, 2), Eigen::Vector3f(3, 4, 5)));
  EXPECT_EQ(middle_of(cloud), Eigen::Vector3f(3, 4, 5)) << "of 2.5, 3.5 and 4.5, in whole metres";
  EXPECT_EQ(middle_of({{{kNaN<float>, 0, 0}}, {}}), Eigen::Vector3f::Zero());
  EXPECT_EQ(middle_of({}), Eigen::Vector3f::Zero());
}

TEST(Thinning, TheFirstPointOfAVoxelStays) {
  const cloud::PointCloud cloud{{{0.6f, 0.1f, 0.1f}, {0.1f, 0.1f, 0.1f}, {1.1f, 0.1f, 0.1f}, {-0.1f, 0, 0}},
                                {}};
  EXPECT_THAT(thinned(cloud, 1.0).points,
              ElementsAre(Eigen::Vector3f(0.6f, 0.1f, 0.1f), Eigen::Vector3f(1.1f, 0.1f, 0.1f),
                          Eigen::Vector3f(-0.1f, 0, 0)));
}

TEST(Thinning, VoxelsGrowUntilFewEnoughAreLeft) {
  const cloud::PointCloud cloud{scattered(5000), {}};
  EXPECT_EQ(thinned_to(cloud, 0.01, 5000).size(), thinned(cloud, 0.01).size()) << "few enough at once";
  const cloud::PointCloud few = thinned_to(cloud, 0.5, 300);
  EXPECT_LE(few.size(), 300u);
  EXPECT_GT(few.size(), 300u / 4) << "a step of 1.5 leaves more than a quarter";
  const auto all = as_set(cloud.points);
  for (const auto& p : few.points) EXPECT_TRUE(all.contains({p.x(), p.y(), p.z()})) << "no point is new";
}

TEST(Thinning, EvenStepsBeginWithTheFirstPoint) {
  Points row;
  for (int k = 0; k < 10; ++k) row.emplace_back(static_cast<float>(k), 0.0f, 0.0f);
  const auto xs = [&](std::size_t max_points) {
    std::vector<float> found;
    for (const auto& p : evenly(row, max_points)) found.push_back(p.x());
    return found;
  };
  EXPECT_THAT(xs(10), SizeIs(10));
  EXPECT_THAT(xs(99), SizeIs(10));
  EXPECT_THAT(xs(9), ElementsAre(0, 2, 4, 6, 8));
  EXPECT_THAT(xs(4), ElementsAre(0, 3, 6, 9));
  EXPECT_THAT(xs(1), ElementsAre(0));
  EXPECT_THAT(evenly({}, 3), IsEmpty());
}

TEST(Thinning, ShufflingKeepsThePointsAndForgetsTheirOrder) {
  Points row;
  for (int k = 0; k < 1000; ++k) row.emplace_back(static_cast<float>(k), 0.0f, 0.0f);
  const Points mixed = shuffled({row, {}}).points;
  EXPECT_EQ(as_set(mixed), as_set(row));
  EXPECT_TRUE(mixed == shuffled({row, {}}).points) << "always the same";
  // Neighbours in a random order are a third of the row apart: 333 with a scatter of 8.
  double apart = 0.0;
  for (std::size_t k = 1; k < mixed.size(); ++k) apart += std::abs(mixed[k].x() - mixed[k - 1].x()) / 999.0;
  EXPECT_NEAR(apart, 333.0, 32.0);
}

TEST(Thinning, SortingByPlaceBringsNeighboursTogether) {
  Points points = scattered(4000);
  const Points before = points;
  const auto way = [](const Points& line) {
    double sum = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).head<2>().norm();
    return sum;
  };
  sort_by_place(points);
  EXPECT_EQ(as_set(points), as_set(before));
  // Within a cell of 4 m two points are 2.1 m apart in the plane, and 21 m anywhere in the square of 40 m.
  EXPECT_LT(way(points) / 4000.0, 2.5);
  EXPECT_GT(way(before) / 4000.0, 15.0);
  Points corners{{1, 0, 0}, {-1, 0, 0}, {-5, 0, 0}, {1, -1, 0}, {2, 0, 0}};
  sort_by_place(corners);
  EXPECT_THAT(corners,
              ElementsAre(Eigen::Vector3f(-5, 0, 0), Eigen::Vector3f(-1, 0, 0), Eigen::Vector3f(1, -1, 0),
                          Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(2, 0, 0)));
}

}  // namespace
}  // namespace fleetmap::eval
