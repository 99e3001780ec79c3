#include "fleetmap/agent/submap_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fleetmap/cloud/kd_tree.hpp"

namespace fleetmap::agent {
namespace {

cloud::PointCloud wall(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(-10.0f, 10.0f);
  cloud::PointCloud points;
  for (std::size_t k = 0; k < count; ++k) points.points.push_back({8.0f, u(random), 0.2f * u(random)});
  points.intensities.assign(count, 50.0f);
  return points;
}

Pose at(double x, double yaw = 0.0) {
  return make_pose(rotation_from_rpy(0, 0, yaw), Eigen::Vector3d(x, 0.0, 0.0));
}

TEST(SubmapBuilder, PointsComeBackInTheNodesFrameWithinVoxelAndRounding) {
  const SubmapConfig config{.voxel = 0.1, .resolution = 0.02};
  SubmapBuilder builder(config);
  const cloud::PointCloud scan = wall(1, 3000);
  builder.add(scan, at(2.0, 0.3));
  const Pose T_odom_node = at(5.0, -0.4);
  const auto frozen = builder.freeze(T_odom_node);
  ASSERT_TRUE(frozen) << frozen.error().message;
  const auto submap = cloud::decode(frozen->encoded);
  ASSERT_TRUE(submap);
  EXPECT_EQ(submap->size(), frozen->points);
  const cloud::PointCloud expected = cloud::transformed(scan, T_odom_node.inverse() * at(2.0, 0.3));
  const cloud::KdTree tree(expected);
  for (const Eigen::Vector3f& p : submap->points) {
    EXPECT_LT(std::sqrt(tree.nearest(p)->squared_distance), 0.5 * 0.02 * std::sqrt(3.0) + 1e-3);
  }
}

TEST(SubmapBuilder, SamePointsAndPosesGiveTheSameBytes) {
  Bytes bytes[2];
  for (Bytes& b : bytes) {
    SubmapBuilder builder(SubmapConfig{});
    for (int k = 0; k < 5; ++k) builder.add(wall(static_cast<unsigned>(k), 500), at(0.5 * k));
    b = builder.freeze(at(2.0))->encoded;
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(SubmapBuilder, StandingStillAddsNothing) {
  SubmapBuilder builder(SubmapConfig{});
  builder.add(wall(1, 1000), at(0.0));
  const std::size_t before = builder.points();
  builder.add(wall(2, 1000), at(0.05));
  EXPECT_EQ(builder.points(), before);
  builder.add(wall(2, 1000), at(0.3));
  EXPECT_GT(builder.points(), before);
}

TEST(SubmapBuilder, FreezingKeepsThePointsUntilTheyAreCleared) {
  SubmapBuilder builder(SubmapConfig{});
  builder.add(wall(1, 1000), at(0.0));
  EXPECT_EQ(builder.freeze(at(0.0))->encoded, builder.freeze(at(0.0))->encoded);
  builder.clear();
  EXPECT_EQ(builder.points(), 0u);
}

TEST(SubmapBuilder, ThinsUntilTheByteLimitHolds) {
  SubmapConfig config{.voxel = 0.02, .resolution = 0.005};
  config.max_bytes = 10'000;
  SubmapBuilder builder(config);
  builder.add(wall(1, 60'000), at(0.0));
  const auto frozen = builder.freeze(at(0.0));
  ASSERT_TRUE(frozen) << frozen.error().message;
  EXPECT_LE(frozen->encoded.size(), 10'000u);
  EXPECT_GT(frozen->voxel, config.voxel);
  EXPECT_GT(frozen->points, 500u);
}

TEST(SubmapBuilder, BadPosesAndPointsAreCountedNotKept) {
  SubmapBuilder builder(SubmapConfig{});
  Pose bad = Pose::Identity();
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  builder.add(wall(1, 10), bad);
  EXPECT_EQ(builder.points(), 0u);
  EXPECT_EQ(builder.refused_points(), 10u);
  cloud::PointCloud points = wall(1, 10);
  points.points[3].y() = std::numeric_limits<float>::infinity();
  builder.add(points, at(0.0));
  EXPECT_EQ(builder.refused_points(), 11u);
}

TEST(SubmapConfig, RulesAreNamed) {
  SubmapConfig config;
  config.resolution = 1.0;
  ASSERT_FALSE(config.validate());
  EXPECT_NE(config.validate().error().message.find("resolution"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::agent
