#include "driving/local_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

constexpr double kFar = 1.6;  // m

TEST(LocalField, ClearanceIsTheDistanceToTheNearestObstacle) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-6.0, 6.0);
  LocalField field(6.2, kFar);
  for (int scan = 0; scan < 5; ++scan) {
    std::vector<Vector2d> obstacles;
    for (int k = 0; k < 30; ++k) obstacles.emplace_back(anywhere(random), anywhere(random));
    field.see(obstacles);
    for (int k = 0; k < 300; ++k) {
      const Vector2d p(anywhere(random), anywhere(random));
      double nearest = kFar;
      for (const Vector2d& obstacle : obstacles) nearest = std::min(nearest, (p - obstacle).norm());
      EXPECT_NEAR(field.clearance(p), nearest, 0.15);  // cells of 0.1 m
    }
  }
  field.see({});
  EXPECT_FLOAT_EQ(static_cast<float>(field.clearance(Vector2d::Zero())), static_cast<float>(kFar));
}

TEST(LocalField, OnOpenGroundTheCostIsTheDistance) {
  LocalField field(6.2, kFar);
  field.see({});
  const LocalField::Source source{{5.0, 0.0}, 2.0};
  field.spread({&source, 1}, 0.4);
  for (const Vector2d& p : {Vector2d(0, 0), Vector2d(-4, 0), Vector2d(3, 3), Vector2d(0, -5)}) {
    const double distance = (p - source.at).norm();
    EXPECT_NEAR(field.cost(p), 2.0 + distance, 0.3 + 0.05 * distance);
  }
  EXPECT_EQ(field.cost({7.0, 0.0}), LocalField::kUnreachable);
}

TEST(LocalField, AWallIsDrivenAroundAndAClosedOneIsNot) {
  std::vector<Vector2d> wall;
  for (double y = -6.2; y <= 3.0; y += 0.05) wall.emplace_back(2.0, y);
  LocalField field(6.2, kFar);
  const LocalField::Source source{{4.0, 0.0}, 0.0};
  field.see(wall);
  field.spread({&source, 1}, 0.4);
  EXPECT_GT(field.cost(Vector2d::Zero()), 2.0 * std::hypot(2.0, 3.0));
  EXPECT_LT(field.cost(Vector2d::Zero()), 20.0);
  for (double y = 3.0; y <= 6.2; y += 0.05) wall.emplace_back(2.0, y);
  field.see(wall);
  field.spread({&source, 1}, 0.4);
  EXPECT_EQ(field.cost(Vector2d::Zero()), LocalField::kUnreachable);
}

TEST(LocalField, AMetreBesideAnObstacleCostsMore) {
  const LocalField field(6.2, kFar);
  EXPECT_DOUBLE_EQ(field.price_of_metre(kFar), 1.0);
  EXPECT_DOUBLE_EQ(field.price_of_metre(0.0), 3.0);
  EXPECT_GT(field.price_of_metre(0.5), field.price_of_metre(1.0));
}

}  // namespace
}  // namespace fleetmap::planning
