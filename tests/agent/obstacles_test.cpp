#include "fleetmap/agent/obstacles.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace fleetmap::agent {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// base_link is 0.1 m above the ground.
constexpr float kGround = -0.1f;

TEST(ObstaclesAmong, TheGroundIsNone) {
  std::vector<Eigen::Vector3f> points;
  for (float x = -6.0f; x <= 6.0f; x += 0.25f)
    for (float y = -6.0f; y <= 6.0f; y += 0.25f) points.emplace_back(x, y, kGround);
  EXPECT_TRUE(obstacles_among(points, {}).empty());
}

TEST(ObstaclesAmong, GroundThatRisesWithDistanceIsNone) {
  std::vector<Eigen::Vector3f> points;
  for (float x = 0.5f; x <= 6.0f; x += 0.1f) points.emplace_back(x, 0.0f, kGround + 0.1f * x);
  EXPECT_TRUE(obstacles_among(points, {}).empty());
}

TEST(ObstaclesAmong, APostIsOneWhereItStands) {
  std::vector<Eigen::Vector3f> points;
  for (float z = 0.0f; z < 2.0f; z += 0.05f) points.emplace_back(3.01f, -1.01f, kGround + z);
  const auto obstacles = obstacles_among(points, {});
  ASSERT_EQ(obstacles.size(), 1u) << "one cell, one obstacle";
  EXPECT_NEAR(obstacles[0].x(), 3.01, 1e-6);
  EXPECT_NEAR(obstacles[0].y(), -1.01, 1e-6);
}

TEST(ObstaclesAmong, APanelOverheadAndWhatIsFarAreNone) {
  EXPECT_TRUE(obstacles_among({{1.0f, 0.0f, kGround + 1.2f}, {6.5f, 0.0f, kGround + 1.5f}}, {}).empty());
  ObstacleConfig tall;
  tall.max_height = 1.5;
  EXPECT_EQ(obstacles_among({{1.0f, 0.0f, kGround + 1.2f}}, tall).size(), 1u);
}

TEST(ObstaclesAmong, PointsThatAreNotFiniteAreLeftOut) {
  const std::vector<Eigen::Vector3f> points{{kNan, 0.0f, 0.4f}, {1.0f, kNan, 0.4f},
                                            {1.0f, 0.0f, kNan}, {kInfinity, 0.0f, 0.4f},
                                            {2.0f, 0.0f, 0.4f}, {1.0f, 1.0f, kInfinity}};
  const auto obstacles = obstacles_among(points, {});
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_NEAR(obstacles[0].x(), 2.0, 1e-6);
}

}  // namespace
}  // namespace fleetmap::agent
