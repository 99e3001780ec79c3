#include "registration/correlative_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "registration/made_world.hpp"
#include "support/points.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using fleetmap::testing::Points;
using testing::level_pose;

/// Posts of different heights at random places on level ground of 40 m x 40 m.
Points place() {
  Points points;
  for (int x = -40; x <= 40; ++x) {
    for (int y = -40; y <= 40; ++y)
      points.emplace_back(0.5f * static_cast<float>(x), 0.5f * static_cast<float>(y), 0.0f);
  }
  std::mt19937 random(2);
  std::uniform_real_distribution<float> across(-14.0f, 14.0f), top(1.0f, 4.0f);
  for (int k = 0; k < 40; ++k) {
    const float x = across(random), y = across(random), height = top(random);
    for (float z = 0.5f; z < height; z += 0.25f) points.emplace_back(x, y, z);
  }
  return points;
}

CorrelationGrid map_of(const Points& points, const Pose& T_points_map = Pose::Identity()) {
  Points moved;
  for (const auto& p : points) moved.push_back((T_points_map.inverse() * p.cast<double>()).cast<float>());
  return correlation_grid(moved, {});
}

CorrelationWindow window_around(const Vector2f& center, float radius_m, float yaw_center, float yaw_half) {
  CorrelationWindow window;
  window.center = center;
  window.radius_m = radius_m;
  window.yaw_center = yaw_center;
  window.yaw_half = yaw_half;
  return window;
}

TEST(CorrelativeSearch, FindsThePoseToACellAndAStepOfTheYaw) {
  for (const double yaw : {0.4, 3.0, -2.0}) {
    const CorrelationGrid target = map_of(place()), source = map_of(place(), level_pose(3.1, -1.7, 0.5, yaw));
    const float around = static_cast<float>(yaw) - 0.3f;
    for (const CorrelationWindow& window :
         {window_around({1, 0}, 5.0f, around, 0.5f), window_around({2, -2}, 3.0f, 0.0f, 4.0f)}) {
      const auto found = correlative_search(target, source, window);
      ASSERT_FALSE(found.empty());
      EXPECT_LT((found[0].xy - Vector2f(3.1f, -1.7f)).cwiseAbs().maxCoeff(), 0.6f) << yaw;
      EXPECT_LT(std::abs(wrap_angle(static_cast<double>(found[0].yaw) - yaw)), 0.045) << yaw;
      EXPECT_NEAR(found[0].height, 0.5f, 0.02f);
      EXPECT_GT(found[0].agreement, 0.65) << "cells of a turned map lie askew";
      EXPECT_NEAR(found[0].overlap, 1.0, 0.01);
      if (found.size() > 1) {
        EXPECT_GT(found[0].agreement, found[1].agreement + 0.1) << "it stands out";
      }
    }
  }
}

/// The source's level is off, as accelerometers are: its floor rises in the target.
TEST(CorrelativeSearch, TheSlopeIsThatOfTheFloorsAgainstEachOther) {
  const Vector2f slope(0.04f, -0.03f);
  Pose T = level_pose(3.1, -1.7, 0.5, 0.4);
  T.linear() =
      so3_exp(Vector3d(static_cast<double>(slope.y()), static_cast<double>(-slope.x()), 0)) * T.linear();
  const auto found =
      correlative_search(map_of(place()), map_of(place(), T), window_around({3, -2}, 2.0f, 0.4f, 0.1f));
  ASSERT_FALSE(found.empty());
  EXPECT_LT((found[0].slope - slope).norm(), 0.01f);
  const auto level = correlative_search(map_of(place()), map_of(place(), level_pose(3.1, -1.7, 0.5, 0.4)),
                                        window_around({3, -2}, 2.0f, 0.4f, 0.1f));
  ASSERT_FALSE(level.empty());
  EXPECT_LT(level[0].slope.norm(), 0.001f);
}

TEST(CorrelativeSearch, LooksNowhereOutsideOfItsWindow) {
  const CorrelationGrid target = map_of(place());
  const auto found = correlative_search(target, target, window_around({6, 3}, 2.3f, 1.0f, 0.2f));
  ASSERT_FALSE(found.empty());
  for (const CorrelationCandidate& candidate : found) {
    EXPECT_LE((candidate.xy - Vector2f(6, 3)).norm(), 2.41f) << "of whole cells";
    EXPECT_LE(std::abs(candidate.yaw - 1.0f), 0.201f);
    EXPECT_LT(candidate.agreement, 0.7) << "the right pose is not among them";
  }
}

TEST(CorrelativeSearch, ReturnsPeaksBestFirstAndNoMoreThanWanted) {
  const CorrelationGrid target = map_of(place());
  CorrelationWindow window = window_around({0, 0}, 10.0f, 0.0f, 4.0f);
  const auto many = correlative_search(target, target, window);
  ASSERT_GT(many.size(), 20u);
  EXPECT_GT(many[0].agreement, 0.95);
  EXPECT_EQ(many[0].xy, Vector2f(0, 0));
  EXPECT_EQ(many[0].yaw, 0.0f);
  const auto value = [](const CorrelationCandidate& c) {
    return c.agreement * std::sqrt(std::min(1.0, c.overlap + 0.5));
  };
  EXPECT_TRUE(
      std::ranges::is_sorted(many, [&](const auto& a, const auto& b) { return value(a) > value(b) + 1e-6; }));
  window.max_candidates = 5;
  const auto few = correlative_search(target, target, window);
  ASSERT_EQ(few.size(), 5u);
  for (std::size_t k = 0; k < few.size(); ++k) {
    EXPECT_EQ(few[k].xy, many[k].xy) << k;
    EXPECT_EQ(few[k].yaw, many[k].yaw) << k;
  }
}

TEST(CorrelativeSearch, WithoutOverlapOrCellsThereIsNothing) {
  const CorrelationGrid target = map_of(place());
  EXPECT_TRUE(correlative_search(target, target, window_around({100, 100}, 5.0f, 0.0f, 0.1f)).empty());
  EXPECT_TRUE(correlative_search(target, correlation_grid({}, {}), CorrelationWindow{}).empty());
  EXPECT_TRUE(correlative_search(correlation_grid({}, {}), target, CorrelationWindow{}).empty());
  // At 24 m most of the source's cells lie where the target saw nothing.
  CorrelationWindow window = window_around({24, 0}, 0.6f, 0.0f, 0.0f);
  window.min_overlap = 0.9;
  EXPECT_TRUE(correlative_search(target, target, window).empty());
  window.min_overlap = 0.1;
  const auto found = correlative_search(target, target, window);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(found[0].overlap, 0.7);
}

}  // namespace
}  // namespace fleetmap::registration
