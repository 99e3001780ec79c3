#include "fleetmap/place/ball_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace fleetmap::place {
namespace {

constexpr double kPi = std::numbers::pi;

/// The law that every query must obey: a linear scan with haversine_distance, ties to the smaller index.
class LinearScan {
 public:
  void insert(const GeoPoint& point) { points_.push_back(point); }
  std::vector<Neighbor> ranked(const GeoPoint& query) const {
    std::vector<Neighbor> all;
    for (std::size_t i = 0; i < points_.size(); ++i)
      all.push_back({i, haversine_distance(query, points_[i])});
    std::stable_sort(all.begin(), all.end(),
                     [](const Neighbor& a, const Neighbor& b) { return a.distance < b.distance; });
    return all;
  }
  const std::vector<GeoPoint>& points() const { return points_; }

 private:
  std::vector<GeoPoint> points_;
};

void expect_equal_to_scan(const BallTree& tree, const LinearScan& scan, const GeoPoint& query) {
  const auto ranked = scan.ranked(query);
  ASSERT_EQ(tree.nearest(query), ranked.front());
  for (const std::size_t k :
       {std::size_t{1}, std::size_t{7}, ranked.size() / 2, ranked.size(), ranked.size() + 3}) {
    const std::vector<Neighbor> expected(
        ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(std::min(k, ranked.size())));
    ASSERT_EQ(tree.k_nearest(query, k), expected) << "k = " << k;
  }
  // Radii that equal a distance exactly are the hard ones: that neighbour, and its ties, belong to the
  // answer.
  for (const std::size_t rank : {std::size_t{0}, ranked.size() / 10, ranked.size() / 2, ranked.size() - 1}) {
    const double distance = ranked[rank].distance;
    for (const double radius : {distance, std::nextafter(distance, 0.0), std::nextafter(distance, 1e9)}) {
      std::vector<Neighbor> expected = ranked;
      std::erase_if(expected, [radius](const Neighbor& n) { return n.distance > radius; });
      ASSERT_EQ(tree.within(query, radius), expected) << "radius = " << radius;
    }
  }
}

using Distribution = std::function<GeoPoint(std::mt19937&, std::size_t index)>;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

GeoPoint on_sphere(std::mt19937& random) {
  return {std::asin(uniform(random, -1.0, 1.0)), uniform(random, -kPi, kPi), uniform(random, -100.0, 3000.0)};
}

GeoPoint near(const GeoPoint& centre, std::mt19937& random, double spread) {
  const double latitude = std::clamp(centre.latitude + uniform(random, -spread, spread), -kPi / 2, kPi / 2);
  return {latitude, std::remainder(centre.longitude + uniform(random, -spread, spread), 2 * kPi), 0.0};
}

struct NamedDistribution {
  std::string name;
  Distribution draw;
};

/// A robot that drives along rows: consecutive nodes 5 m apart, rows 8 m apart, exactly along parallels.
GeoPoint along_rows(std::size_t index) {
  const double metre = 1.0 / kMeanEarthRadius;
  const std::size_t row = index / 40;
  const std::size_t column = row % 2 == 0 ? index % 40 : 39 - index % 40;
  return {0.7 + 8.0 * metre * static_cast<double>(row), 0.2 + 5.0 * metre * static_cast<double>(column), 0.0};
}

const std::vector<NamedDistribution>& distributions() {
  static const std::vector<NamedDistribution> all{
      {"sphere", [](std::mt19937& r, std::size_t) { return on_sphere(r); }},
      {"rows", [](std::mt19937&, std::size_t i) { return along_rows(i); }},
      {"site",
       [](std::mt19937& r, std::size_t) {
         return near({0.85, 0.15, 0.0}, r, 2e-4);
       }},
      {"north_pole",
       [](std::mt19937& r, std::size_t) -> GeoPoint {
         return {kPi / 2 - uniform(r, 0.0, 1e-5), uniform(r, -kPi, kPi), 0.0};
       }},
      {"exact_poles",
       [](std::mt19937& r, std::size_t i) -> GeoPoint {
         return {i % 2 == 0 ? kPi / 2 : -kPi / 2, uniform(r, -kPi, kPi), 0.0};
       }},
      {"antimeridian",
       [](std::mt19937& r, std::size_t) {
         return near({-0.3, kPi, 0.0}, r, 1e-5);
       }},
      {"exact_antimeridian",
       [](std::mt19937& r, std::size_t i) -> GeoPoint {
         return {uniform(r, -1e-6, 1e-6), i % 2 == 0 ? kPi : -kPi, 0.0};
       }},
      {"duplicates",
       [](std::mt19937& r, std::size_t) -> GeoPoint {
         return {0.1 * static_cast<double>(r() % 4), 0.1 * static_cast<double>(r() % 3),
                 uniform(r, 0.0, 9.0)};
       }},
      {"last_bits",
       [](std::mt19937& r, std::size_t) -> GeoPoint {
         GeoPoint p{1.2, 0.9, 0.0};
         for (auto i = r() % 5; i > 0; --i) p.latitude = std::nextafter(p.latitude, 2.0);
         for (auto i = r() % 5; i > 0; --i) p.longitude = std::nextafter(p.longitude, 2.0);
         return p;
       }},
      {"one_parallel_and_a_few",
       [](std::mt19937& r, std::size_t i) -> GeoPoint {
         return {i % 20 == 0 ? uniform(r, -0.5, 0.5) : 0.25, uniform(r, -1e-4, 1e-4), 0.0};
       }},
      {"antipodes",
       [](std::mt19937& r, std::size_t i) {
         return i % 2 == 0 ? near({0.4, 1.0, 0.0}, r, 1e-7) : near({-0.4, 1.0 - kPi, 0.0}, r, 1e-7);
       }},
  };
  return all;
}

class BallTreeLaw : public ::testing::TestWithParam<NamedDistribution> {};

TEST_P(BallTreeLaw, EveryQueryEqualsALinearScanWhileTheTreeGrows) {
  std::mt19937 random(7);
  BallTree tree;
  LinearScan scan;
  for (std::size_t i = 0; i < 700; ++i) {
    const GeoPoint point = GetParam().draw(random, i);
    ASSERT_EQ(tree.insert(point), i);
    scan.insert(point);
    if (i > 40 && i % 97 != 0) continue;
    const GeoPoint other = GetParam().draw(random, random() % 1000);
    const GeoPoint known = scan.points()[random() % scan.points().size()];
    const GeoPoint antipode{-known.latitude,
                            known.longitude > 0 ? known.longitude - kPi : known.longitude + kPi, 0.0};
    for (const GeoPoint& query : {other, known, antipode, on_sphere(random), GeoPoint{kPi / 2, 0.3, 0.0},
                                  GeoPoint{-kPi / 2, -1.0, 0.0}, GeoPoint{0.0, kPi, 0.0}}) {
      expect_equal_to_scan(tree, scan, query);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(tree.size(), 700u);
}

INSTANTIATE_TEST_SUITE_P(OnEarth, BallTreeLaw, ::testing::ValuesIn(distributions()),
                         [](const auto& info) { return info.param.name; });

TEST(BallTree, NearestEqualsALinearScanOnLargerTrees) {
  std::mt19937 random(11);
  for (const auto& distribution : distributions()) {
    BallTree tree;
    LinearScan scan;
    for (std::size_t i = 0; i < 20000; ++i) {
      const GeoPoint point = distribution.draw(random, i);
      tree.insert(point);
      scan.insert(point);
    }
    for (int i = 0; i < 20; ++i) {
      const GeoPoint query = i % 2 == 0 ? distribution.draw(random, random() % 20000) : on_sphere(random);
      const auto ranked = scan.ranked(query);
      ASSERT_EQ(tree.nearest(query), ranked.front()) << distribution.name;
      ASSERT_EQ(tree.k_nearest(query, 50), std::vector<Neighbor>(ranked.begin(), ranked.begin() + 50))
          << distribution.name;
    }
  }
}

TEST(BallTree, EmptyTreeHasNoNeighbours) {
  const BallTree tree;
  EXPECT_FALSE(tree.nearest({0.1, 0.2, 0.0}));
  EXPECT_TRUE(tree.k_nearest({0.1, 0.2, 0.0}, 3).empty());
  EXPECT_TRUE(tree.within({0.1, 0.2, 0.0}, 1e9).empty());
  EXPECT_EQ(tree.size(), 0u);
}

TEST(BallTree, RefusesPointsThatAreNotOnEarth) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  BallTree tree;
  ASSERT_EQ(tree.insert({0.5, 0.5, 10.0}), 0u);
  for (const GeoPoint& bad : {GeoPoint{kNaN, 0.0, 0.0}, GeoPoint{0.0, kNaN, 0.0}, GeoPoint{0.0, 0.0, kInf},
                              GeoPoint{1.6, 0.0, 0.0}, GeoPoint{0.0, 3.2, 0.0}, GeoPoint{49.0, 8.4, 0.0}}) {
    EXPECT_EQ(tree.insert(bad), BallTree::kRefused);
    EXPECT_FALSE(tree.nearest(bad));
    EXPECT_TRUE(tree.k_nearest(bad, 1).empty());
    EXPECT_TRUE(tree.within(bad, 1e9).empty());
  }
  EXPECT_EQ(tree.insert({0.6, 0.5, 10.0}), 1u);
  EXPECT_EQ(tree.size(), 2u);
}

TEST(BallTree, RadiusEdges) {
  BallTree tree;
  tree.insert({0.5, 0.5, 0.0});
  tree.insert({-0.5, 0.5 - kPi, 0.0});
  EXPECT_TRUE(tree.within({0.5, 0.5, 0.0}, -1.0).empty());
  EXPECT_TRUE(tree.within({0.5, 0.5, 0.0}, std::numeric_limits<double>::quiet_NaN()).empty());
  EXPECT_EQ(tree.within({0.5, 0.5, 0.0}, 0.0).size(), 1u);
  EXPECT_EQ(tree.within({0.5, 0.5, 0.0}, std::numeric_limits<double>::infinity()).size(), 2u);
  EXPECT_TRUE(tree.k_nearest({0.5, 0.5, 0.0}, 0).empty());
}

TEST(BallTree, KeepsThePointAsInserted) {
  BallTree tree;
  const GeoPoint point{0.855, 0.147, 112.5};
  tree.insert(point);
  EXPECT_EQ(tree.point(0), point);
}

TEST(BallTree, ManyDuplicatesAnswerWithTheFirst) {
  BallTree tree;
  for (std::size_t i = 0; i < 200000; ++i) ASSERT_EQ(tree.insert({0.8, 0.1, static_cast<double>(i)}), i);
  for (int i = 0; i < 20000; ++i) ASSERT_EQ(tree.nearest({0.8, 0.1, 0.0}), (Neighbor{0, 0.0}));
  EXPECT_EQ(tree.within({0.8, 0.1, 0.0}, 1.0).size(), 200000u);
}

}  // namespace
}  // namespace fleetmap::place
