#include "local_mapping.hpp"

#include <gtest/gtest.h>

namespace fleetmap::odometry {
namespace {

/// A wall of 4 m by 2 m, 5 m ahead of the robot.
std::vector<FeaturePoint> wall() {
  std::vector<FeaturePoint> points;
  for (int y = -20; y <= 20; ++y) {
    for (int z = 0; z <= 20; ++z)
      points.push_back({{5.0f, 0.1f * static_cast<float>(y), 0.1f * static_cast<float>(z)}});
  }
  return points;
}

MotionState state_at(double x) {
  MotionState state;
  state.T_odom_base.translation().x() = x;
  return state;
}

TEST(LocalMapping, AfterTheFirstScansOnlyMotionMakesAKeyframe) {
  const LoamConfig config;
  LocalMapping mapping(config);
  for (int k = 0; k < 6; ++k) {
    EXPECT_TRUE(mapping.is_keyframe(Pose::Identity())) << k;
    mapping.insert(wall(), {}, {});
  }
  EXPECT_FALSE(mapping.is_keyframe(Pose::Identity()));
  EXPECT_FALSE(mapping.is_keyframe(state_at(0.9 * config.keyframe_distance).T_odom_base));
  EXPECT_TRUE(mapping.is_keyframe(state_at(1.1 * config.keyframe_distance).T_odom_base));
  Pose turned = Pose::Identity();
  turned.linear() = so3_exp({0.0, 0.0, 1.1 * config.keyframe_angle});
  EXPECT_TRUE(mapping.is_keyframe(turned));
  mapping.clear();
  EXPECT_FALSE(mapping.is_keyframe(Pose::Identity()));
  mapping.restart();
  EXPECT_TRUE(mapping.is_keyframe(Pose::Identity()));
}

TEST(LocalMapping, PointsEnterTheMapMotionCompensated) {
  LoamConfig config;
  LocalMapping mapping(config);
  std::vector<FeaturePoint> points = wall();
  for (FeaturePoint& p : points) p.time = 0.5f;
  MotionState state = state_at(10.0);
  state.twist[0] = 2.0;  // a point fired 0.5 s later is 1 m farther on
  for (int k = 0; k < 3; ++k) mapping.insert(points, {}, state);
  const Surface* surface = mapping.map().surface_at({16.0, 0.0, 1.0}, {10.0, 0.0, 1.0});
  ASSERT_NE(surface, nullptr);
  EXPECT_NEAR(surface->mean.x(), 16.0, 0.05);
}

TEST(LocalMapping, FarSurfacesAreRemoved) {
  LoamConfig config;
  LocalMapping mapping(config);
  mapping.insert(wall(), {}, state_at(0.0));
  const std::size_t one = mapping.size().windows;
  ASSERT_GT(one, 0u);
  mapping.insert(wall(), {}, state_at(20.0));
  EXPECT_GT(mapping.size().windows, one);
  mapping.insert({}, {}, state_at(25.0 + 2.0 * config.map_radius));
  EXPECT_EQ(mapping.size().windows, 0u);
}

TEST(LocalMapping, AFullMapForgetsItsFarthestWindows) {
  LoamConfig config;
  LocalMapping unbounded(config);
  unbounded.insert(wall(), {}, state_at(0.0));
  config.max_map_windows = static_cast<int>(unbounded.size().windows) + 1;
  LocalMapping mapping(config);
  mapping.insert(wall(), {}, state_at(0.0));
  EXPECT_EQ(mapping.overflows(), 0u);
  mapping.insert(wall(), {}, state_at(6.0));
  EXPECT_EQ(mapping.overflows(), 1u);
  EXPECT_LE(static_cast<int>(mapping.size().windows), config.max_map_windows);
}

}  // namespace
}  // namespace fleetmap::odometry
