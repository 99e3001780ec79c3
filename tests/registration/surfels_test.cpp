#include "registration/surfels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "support/points.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector3f;
using fleetmap::testing::Points;
using Reach = SurfelMap::Reach;

constexpr float kNoise = SurfelConfig{}.noise_m;

/// A level square at height 0 with its middle at x = 0, y = 3.
Points level_square(float edge, float spacing) {
  Points points;
  const int half = static_cast<int>(std::lround(0.5f * edge / spacing));
  for (int x = -half; x <= half; ++x) {
    for (int y = -half; y <= half; ++y)
      points.emplace_back(spacing * static_cast<float>(x), 3.0f + spacing * static_cast<float>(y), 0.0f);
  }
  return points;
}

/// A thin upright post.
Points post(float x, float y) {
  Points points;
  for (int k = 0; k < 400; ++k) {
    const float angle = 2.4f * static_cast<float>(k);
    points.emplace_back(x + 0.05f * std::cos(angle), y + 0.05f * std::sin(angle),
                        0.005f * static_cast<float>(k));
  }
  return points;
}

const Surfel* nearest(const SurfelMap& map, const Vector3f& p, Reach reach = Reach::near) {
  const Surfel* found = nullptr;
  map.find({&p, 1}, reach, &found);
  return found;
}

TEST(Surfels, APlaneConstrainsAcrossIt) {
  const SurfelMap map(level_square(6.0f, 0.1f), {});
  const Surfel* surfel = nearest(map, {0.1f, 2.9f, 0.05f});
  ASSERT_NE(surfel, nullptr);
  EXPECT_TRUE(surfel->planar);
  EXPECT_EQ(surfel->directions, 1);
  EXPECT_NEAR(std::abs(surfel->axes[0].z()), 1.0f, 1e-4f);
  EXPECT_NEAR(surfel->mean.z(), 0.0f, 1e-5f);
  EXPECT_NEAR(surfel->weights[0], 1.0f / (kNoise * kNoise), 0.01f / (kNoise * kNoise));
  EXPECT_NEAR(surfel->side * surfel->axes[0].z(), kSensorHeight, 1e-3f) << "the sensor was above it";
}

/// The post is known less well along the line of sight, where the other side may be seen later.
TEST(Surfels, APostConstrainsAcrossTheLineOfSightAndLessAlongIt) {
  const SurfelConfig config;
  const SurfelMap map(post(5.0f, 3.0f), config);
  const Surfel* surfel = nearest(map, {5.0f, 3.0f, 1.0f});
  ASSERT_NE(surfel, nullptr);
  EXPECT_FALSE(surfel->planar);
  EXPECT_EQ(surfel->directions, 2);
  EXPECT_LT((surfel->mean.head<2>() - Eigen::Vector2f(5, 3)).norm(), 0.005f);
  EXPECT_GT(std::abs(surfel->axes[0].x()), 0.999f) << "the sensor passed on the x axis";
  EXPECT_LT(surfel->axes[1].y(), -0.999f) << "towards the sensor";
  EXPECT_NEAR(surfel->side, 3.0f, 0.01f);
  const float certain = 0.5f * 0.05f * 0.05f + kNoise * kNoise;
  const float hidden = config.hidden_depth_m * config.hidden_depth_m;
  EXPECT_NEAR(surfel->weights[0], 1.0f / certain, 0.05f / certain);
  EXPECT_NEAR(surfel->weights[1], 1.0f / (certain + hidden), 0.05f / (certain + hidden));
}

TEST(Surfels, ClutterConstrainsAllDirectionsAndASpeckNone) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  Points bush, speck;
  for (int k = 0; k < 4000; ++k) bush.emplace_back(unit(random), unit(random), unit(random));
  for (int k = 0; k < 40; ++k) speck.push_back(0.05f * Vector3f(unit(random), unit(random), unit(random)));
  const SurfelMap clutter(bush, {}), small(speck, {});
  const Surfel* surfel = nearest(clutter, {0, 0, 0});
  ASSERT_NE(surfel, nullptr);
  EXPECT_EQ(surfel->directions, 3);
  EXPECT_FALSE(surfel->planar);
  EXPECT_NEAR(surfel->weights[0], 12.0f / (1.05f * 1.05f), 2.0f) << "of points spread over 1.05 m";
  surfel = nearest(small, {0, 0, 0});
  ASSERT_NE(surfel, nullptr);
  EXPECT_EQ(surfel->directions, 0);
}

TEST(Surfels, ReachAboutAVoxelOrThree) {
  const SurfelMap map(level_square(6.0f, 0.1f), {});
  EXPECT_NE(nearest(map, {0, 3, 0.3f}), nullptr);
  EXPECT_EQ(nearest(map, {0, 3, 1.0f}), nullptr);
  EXPECT_NE(nearest(map, {0, 3, 1.0f}, Reach::far), nullptr);
  EXPECT_EQ(nearest(map, {0, 3, 2.5f}, Reach::far), nullptr);
  EXPECT_EQ(nearest(map, {50, 3, 0}, Reach::far), nullptr);
  EXPECT_EQ(nearest(map, {std::nanf(""), 3, 0}), nullptr);
  EXPECT_EQ(nearest(SurfelMap(), {0, 0, 0}), nullptr);
  EXPECT_EQ(nearest(SurfelMap(Points{}, {}), {0, 0, 0}), nullptr);
}

TEST(Surfels, ManyPointsFindWhatEachFindsAlone) {
  Points points = level_square(6.0f, 0.1f);
  for (const Vector3f& p : post(1.0f, 2.0f)) points.push_back(p);
  const SurfelMap map(points, {});
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-5.0f, 5.0f);
  Points queries;
  for (std::size_t k = 0; k < SurfelMap::kBlock; ++k)
    queries.emplace_back(unit(random), 3.0f + unit(random), 0.08f * unit(random));
  for (const Reach reach : {Reach::near, Reach::far}) {
    std::array<const Surfel*, SurfelMap::kBlock> found;
    map.find(queries, reach, found.data());
    std::size_t none = 0;
    for (std::size_t k = 0; k < queries.size(); ++k) {
      EXPECT_EQ(found[k], nearest(map, queries[k], reach)) << k;
      none += found[k] == nullptr ? 1 : 0;
    }
    EXPECT_GT(none, 3u);
    EXPECT_LT(none, 50u);
  }
}

/// Ground far from the robot is thinned so much that no voxel holds enough of it.
TEST(Surfels, SparseGroundHasLargerSurfels) {
  Points points = level_square(24.0f, 1.2f);
  points.emplace_back(0.0f, 3.0f, 2.0f);  // a leaf above it
  const SurfelMap map(points, {});
  const Surfel* surfel = nearest(map, {0.3f, 3.4f, 0.1f});
  ASSERT_NE(surfel, nullptr);
  EXPECT_TRUE(surfel->planar);
  EXPECT_NEAR(std::abs(surfel->axes[0].z()), 1.0f, 1e-4f);
  EXPECT_NEAR(surfel->mean.z(), 0.0f, 1e-4f);
  EXPECT_EQ(map.of_points().back(), SurfelMap::kNone);
}

TEST(Surfels, EachPointHasTheSurfelOfItsVoxel) {
  Points points = level_square(4.0f, 0.1f);
  points.emplace_back(0.0f, 0.0f, 30.0f);
  const SurfelMap map(points, {});
  ASSERT_EQ(map.of_points().size(), points.size());
  EXPECT_EQ(map.of_points().back(), SurfelMap::kNone) << "alone it has none";
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const std::uint16_t at = map.of_points()[i];
    ASSERT_LT(at, map.surfels().size());
    EXPECT_LT((map.surfels()[at].mean - points[i]).norm(), 0.6f);
  }
}

}  // namespace
}  // namespace fleetmap::registration
