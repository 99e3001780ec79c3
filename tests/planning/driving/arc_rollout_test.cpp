#include "driving/arc_rollout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

constexpr RolloutConfig kConfig{.length = 2.4, .touch = 0.4, .wanted_clearance = 1.6};

/// The robot looks along x; `aim` is where it is to get on.
LocalField field_with(const std::vector<Vector2d>& obstacles, const Vector2d& aim) {
  LocalField field(6.2, kConfig.wanted_clearance);
  field.see(obstacles);
  const LocalField::Source source{aim, 0.0};
  field.spread({&source, 1}, kConfig.touch);
  return field;
}

std::vector<Vector2d> wall(const Vector2d& a, const Vector2d& b) {
  std::vector<Vector2d> points;
  const int count = static_cast<int>((b - a).norm() / 0.05);
  for (int k = 0; k <= count; ++k) points.push_back(a + (b - a) * k / count);
  return points;
}

TEST(ArcRollout, OnOpenGroundTheArcLeadsToTheAim) {
  EXPECT_EQ(best_arc(field_with({}, {5.0, 0.0}), kConfig).curvature, 0.0);
  const LocalField left = field_with({}, {3.0, 3.0});
  const LocalField right = field_with({}, {3.0, -3.0});
  EXPECT_GT(best_arc(left, kConfig).curvature, 0.1);
  EXPECT_LT(best_arc(right, kConfig).curvature, -0.1);
  EXPECT_NEAR(descent_heading(left), M_PI / 4.0, 0.15);
  EXPECT_NEAR(descent_heading(right), -M_PI / 4.0, 0.15);
}

TEST(ArcRollout, AnArcEndsBeforeItTouches) {
  const LocalField field = field_with(wall({1.5, -0.5}, {1.5, 0.5}), {5.0, 0.0});
  const Arc straight = roll_out(field, 0.0, kConfig);
  EXPECT_NEAR(straight.free, 1.5 - kConfig.touch, kRolloutStep + 0.1);
  EXPECT_NEAR(straight.clearance, 0.6, 0.15);  // a metre on
  const Arc best = best_arc(field, kConfig);
  EXPECT_NE(best.curvature, 0.0);
  EXPECT_LT(best.score, straight.score);
}

TEST(ArcRollout, WithoutAWayNoArcHasAScore) {
  std::vector<Vector2d> cage;
  for (const auto& [a, b] : {std::pair<Vector2d, Vector2d>{{0.3, -0.3}, {0.3, 0.3}},
                             {{-0.3, -0.3}, {-0.3, 0.3}},
                             {{-0.3, 0.3}, {0.3, 0.3}},
                             {{-0.3, -0.3}, {0.3, -0.3}}}) {
    const auto side = wall(a, b);
    cage.insert(cage.end(), side.begin(), side.end());
  }
  const LocalField field = field_with(cage, {5.0, 0.0});
  EXPECT_EQ(best_arc(field, kConfig).score, LocalField::kUnreachable);
  EXPECT_EQ(descent_heading(field), 0.0);
}

TEST(ArcRollout, ChangingTheCurvatureHasAPrice) {
  const LocalField field = field_with({}, {5.0, 0.0});
  RolloutConfig turning = kConfig;
  turning.last_curvature = 0.45;
  EXPECT_NEAR(roll_out(field, 0.0, turning).score - roll_out(field, 0.0, kConfig).score, 0.05 * 0.45, 1e-9);
}

}  // namespace
}  // namespace fleetmap::planning
