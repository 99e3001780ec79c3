#include "fleetmap/cloud/kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::kNaN;

std::vector<Eigen::Vector3f> random_points(std::size_t count, unsigned seed, bool on_lattice) {
  std::mt19937 random(seed);
  std::vector<Eigen::Vector3f> points;
  std::uniform_real_distribution<float> coordinate(-20.0f, 20.0f);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3f p(coordinate(random), coordinate(random), coordinate(random));
    points.push_back(on_lattice ? Eigen::Vector3f((p / 5.0f).array().round() * 5.0f) : p);
  }
  return points;
}

std::vector<float> sorted_squares(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query) {
  std::vector<float> squares;
  for (const auto& p : points) squares.push_back((p - query).squaredNorm());
  std::sort(squares.begin(), squares.end());
  return squares;
}

/// Law: equal to brute force, with and without many equal points.
TEST(KdTree, AgreesWithBruteForce) {
  for (const bool on_lattice : {false, true}) {
    for (const std::size_t count : {1u, 7u, 300u, 3000u}) {
      const auto points = random_points(count, static_cast<unsigned>(count), on_lattice);
      const KdTree tree(points);
      for (const auto& query : random_points(60, 99, false)) {
        const auto squares = sorted_squares(points, query);
        ASSERT_FLOAT_EQ(tree.nearest(query)->squared_distance, squares[0]);
        const auto nearest = tree.knn(query, 10);
        ASSERT_EQ(nearest.size(), std::min<std::size_t>(10, count));
        for (std::size_t i = 0; i < nearest.size(); ++i) {
          ASSERT_FLOAT_EQ(nearest[i].squared_distance, squares[i]);
          ASSERT_FLOAT_EQ((points[nearest[i].index] - query).squaredNorm(), squares[i]);
        }
        const auto within = tree.radius(query, 6.0f);
        ASSERT_EQ(within.size(), static_cast<std::size_t>(std::count_if(squares.begin(), squares.end(),
                                                                        [](float s) { return s < 36.0f; })));
        ASSERT_TRUE(std::is_sorted(within.begin(), within.end(), [](const Neighbor& a, const Neighbor& b) {
          return a.squared_distance < b.squared_distance;
        }));
      }
    }
  }
}

TEST(KdTree, NearestNeighboursCloserThanADistanceAreTheFirstOfAll) {
  const auto points = random_points(2000, 5, false);
  const KdTree tree(points);
  std::array<Neighbor, 20> found;
  for (const auto& query : random_points(60, 98, false)) {
    const auto all = tree.knn(query, found.size());
    const float reach = 0.5f * (std::sqrt(all[6].squared_distance) + std::sqrt(all[7].squared_distance));
    ASSERT_EQ(tree.knn(query, found, reach), 7u);
    for (std::size_t i = 0; i < 7; ++i) ASSERT_EQ(found[i], all[i]);
  }
  EXPECT_EQ(tree.knn({0, 0, 0}, found, 0.0f), 0u);
}

TEST(KdTree, NearestRespectsItsMaximumDistance) {
  const KdTree tree(std::vector<Eigen::Vector3f>{{1, 0, 0}, {5, 0, 0}});
  EXPECT_FALSE(tree.nearest({0, 0, 0}, 0.9f));
  EXPECT_EQ(tree.nearest({0, 0, 0}, 1.1f)->index, 0u);
  EXPECT_FALSE(tree.nearest({0, 0, 0}, -1.0f));
}

TEST(KdTree, NonFinitePointsAreNeverFoundAndIndicesStayThoseOfTheCloud) {
  const KdTree tree(
      std::vector<Eigen::Vector3f>{{kNaN<float>, 0, 0}, {1, 0, 0}, {0, INFINITY, 0}, {2, 0, 0}});
  EXPECT_EQ(tree.size(), 2u);
  const auto found = tree.knn({0, 0, 0}, 5);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].index, 1u);
  EXPECT_EQ(found[1].index, 3u);
  EXPECT_FALSE(tree.nearest({kNaN<float>, 0, 0}));
  EXPECT_TRUE(tree.radius({kNaN<float>, 0, 0}, 10.0f).empty());
}

TEST(KdTree, AnEmptyCloudFindsNothing) {
  const KdTree tree(PointCloud{});
  EXPECT_FALSE(tree.nearest({0, 0, 0}));
  EXPECT_TRUE(tree.knn({0, 0, 0}, 3).empty());
  EXPECT_TRUE(tree.radius({0, 0, 0}, 3.0f).empty());
}

}  // namespace
}  // namespace fleetmap::cloud
