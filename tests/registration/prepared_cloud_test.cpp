#include "fleetmap/registration/prepared_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <utility>

#include "registration/made_world.hpp"
#include "registration/prepared_data.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

cloud::PointCloud cloud_of(std::initializer_list<Vector3f> points) { return {points, {}}; }

/// Level ground of 24 m x 24 m at height -1 and a wall on it, one point in every voxel of 0.1 m.
cloud::PointCloud yard() {
  cloud::PointCloud cloud;
  for (double x = -11.95; x < 12.0; x += 0.2) {
    for (double y = -11.95; y < 12.0; y += 0.2) cloud.points.push_back(Vector3d(x, y, -0.95).cast<float>());
    for (double z = -0.75; z < 1.5; z += 0.2) cloud.points.push_back(Vector3d(x, 6.05, z).cast<float>());
  }
  return cloud;
}

PreparedCloud prepared_with(const cloud::PointCloud& cloud, const RegistrationConfig& config = {}) {
  return PreparedCloud(cloud, Vector3d::UnitZ(), config);
}

TEST(PreparedCloud, EmptyInputGivesEmptyOutput) {
  EXPECT_EQ(PreparedCloud().size(), 0u);
  EXPECT_EQ(PreparedCloud().data(), nullptr);
  const PreparedCloud empty = prepared_with({});
  ASSERT_NE(empty.data(), nullptr);
  EXPECT_EQ(empty.size(), 0u);
  EXPECT_EQ(empty.data()->noise_m, 0.0);
}

TEST(PreparedCloud, IsThinnedAndHasNoPointsThatAreFarOrNotFinite) {
  RegistrationConfig config;
  config.max_range_m = 20.0f;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const PreparedCloud cloud = prepared_with(
      cloud_of(
          {{1.01f, 2.01f, 3.01f}, {1.05f, 2.07f, 3.03f}, {0.0f, nan, 0.0f}, {19.9f, 0, 0}, {12, 12, 12}}),
      config);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_LT((cloud.data()->all.points[0] - Vector3f(1.03f, 2.04f, 3.02f)).norm(), 1e-5f);
  EXPECT_LT((cloud.data()->all.points[1] - Vector3f(19.9f, 0, 0)).norm(), 1e-5f);
}

TEST(PreparedCloud, IsLevelled) {
  const PreparedCloud cloud(cloud_of({{5, 1, 2}}), 3.0 * Vector3d::UnitX(), {});
  ASSERT_EQ(cloud.size(), 1u);
  const Vector3f p = cloud.data()->all.points[0];
  EXPECT_NEAR(p.z(), 5.0f, 1e-5f);
  EXPECT_NEAR(p.head<2>().norm(), std::hypot(1.0f, 2.0f), 1e-5f);
  EXPECT_LT((cloud.data()->R_level_cloud * Vector3d::UnitX() - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(PreparedCloud, PicksAsManyPointsAsTheConfigurationSaysFromTheWhole) {
  RegistrationConfig config;
  config.fine_points = 300;
  config.coarse_points = 60;
  const PreparedCloud cloud = prepared_with(yard(), config);
  const PreparedCloud::Data& data = *cloud.data();
  EXPECT_EQ(data.all.points.size(), cloud.size());
  EXPECT_GT(cloud.size(), 10'000u);
  EXPECT_EQ(data.fine.points.size(), 300u);
  EXPECT_EQ(data.middle.points.size(), 120u);
  EXPECT_EQ(data.coarse.points.size(), 60u);
  float low = 0.0f, high = 0.0f;
  for (const Vector3f& p : data.coarse.points) low = std::min(low, p.x()), high = std::max(high, p.x());
  EXPECT_LT(low, -11.0f);
  EXPECT_GT(high, 11.0f);
  config.fine_points = 1'000'000;
  EXPECT_EQ(prepared_with(yard(), config).data()->fine.points.size(), cloud.size());
}

TEST(PreparedCloud, EveryPointHasItsPatchItsSideAndWhetherItIsFloor) {
  const PreparedCloud cloud = prepared_with(yard());
  const MovingPoints& all = cloud.data()->all;
  ASSERT_EQ(all.patches.size(), all.points.size());
  ASSERT_EQ(all.facing.size(), all.points.size());
  ASSERT_EQ(all.above_floor.size(), all.points.size());
  std::set<std::pair<std::uint16_t, std::pair<int, int>>> patches;
  std::size_t walls = 0, grounds = 0;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const Vector3f& p = all.points[i];
    ASSERT_LT(all.patches[i], all.patch_count);
    const auto square = [](float v) { return static_cast<int>(std::floor(v / 4.0f)); };
    patches.insert({all.patches[i], {square(p.x()), square(p.y())}});
    ASSERT_EQ(all.above_floor[i] != 0, p.z() > -0.6f);
    if (std::abs(p.x()) > 11.0f || std::abs(p.y()) > 11.0f) continue;
    if (p.z() > 0.2f && p.z() < 1.0f) {
      ++walls;
      ASSERT_TRUE(all.facing[i].planar);
      EXPECT_GT(std::abs(all.facing[i].normal.y()), 0.99f);
      EXPECT_NEAR(all.facing[i].side * all.facing[i].normal.y(), -6.05f, 0.1f) << "of the sensor at y = 0";
    } else if (p.z() < -0.9f && std::abs(p.y() - 6.05f) > 1.5f) {
      ++grounds;
      ASSERT_TRUE(all.facing[i].planar);
      EXPECT_GT(std::abs(all.facing[i].normal.z()), 0.99f);
    }
  }
  EXPECT_EQ(patches.size(), 36u) << "squares of 4 m, one patch each";
  EXPECT_GT(walls, 300u);
  EXPECT_GT(grounds, 5'000u);
}

TEST(PreparedCloud, CopiesShareTheirData) {
  const PreparedCloud cloud = prepared_with(yard());
  const PreparedCloud copy = cloud;
  EXPECT_EQ(copy.data(), cloud.data());
}

TEST(PreparedCloud, HoldsFeaturesAloneForThePapersMethod) {
  RegistrationConfig config;
  config.method = Method::paper;
  const auto scan = testing::MadeWorld(3).scan(Pose::Identity(), 5'000, 0.02, 1);
  const PreparedCloud cloud = prepared_with(scan, config);
  ASSERT_NE(cloud.data(), nullptr);
  EXPECT_GT(cloud.size(), 100u);
  EXPECT_EQ(cloud.size(), cloud.data()->features.size());
  EXPECT_TRUE(cloud.data()->all.points.empty());
}

}  // namespace
}  // namespace fleetmap::registration
