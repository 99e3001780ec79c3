#include "fleetmap/registration/spherize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using testing::MadeWorld;

PointCloud dense_map(double tilt = 0.0) {
  return MadeWorld(7).scan(make_pose(rotation_from_rpy(0.0, tilt, 0.0), Eigen::Vector3d(0, 0, 1.2)), 250'000,
                           0.02, 7, 60.0);
}

TEST(Spherize, GivesABallWithoutGroundWithinTheBudget) {
  SpherizeConfig config;
  config.ground_voxel_m = 0.0f;
  const auto result = spherize(dense_map(), Eigen::Vector3f::UnitZ(), config);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LE(result->bytes.size(), 25'000u);
  EXPECT_GE(result->bytes.size(), 22'500u);
  EXPECT_GT(result->encoded, 10'000u);
  EXPECT_EQ(result->decoded.points, cloud::decode(result->bytes)->points);
  EXPECT_EQ(result->encoded, result->decoded.size());
  EXPECT_LT(result->in_ball, result->points_in);
  std::size_t low = 0;
  for (const auto& p : result->decoded.points) {
    EXPECT_LE(p.norm(), 40.5f);
    low += p.z() < -1.1f ? 1u : 0u;
  }
  EXPECT_LT(static_cast<double>(low), 0.02 * static_cast<double>(result->encoded));
}

TEST(Spherize, SpherizingPartsEqualsSpherizingTheWhole) {
  const PointCloud map = dense_map();
  const Pose T = make_pose(rotation_from_rpy(0.0, 0.0, 0.5), Eigen::Vector3d(20, -7, 0.3));
  std::vector<std::size_t> first(map.size() / 3), second;
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (std::size_t i = first.size(); i < map.size(); ++i) second.push_back(i);
  const PointCloud a = cloud::select(map, first);
  const PointCloud b = cloud::transformed(cloud::select(map, second), T.inverse());
  const std::array<PlacedCloud, 2> parts{PlacedCloud{&a, Pose::Identity()}, PlacedCloud{&b, T}};
  const auto whole = spherize(map, Eigen::Vector3f::UnitZ(), {});
  const auto joined = spherize(parts, Eigen::Vector3f::UnitZ(), {});
  ASSERT_TRUE(whole && joined);
  EXPECT_EQ(joined->points_in, map.size());
  EXPECT_NEAR(static_cast<double>(joined->thinned), static_cast<double>(whole->thinned), 20.0) << "rounding";
  EXPECT_NEAR(static_cast<double>(joined->encoded), static_cast<double>(whole->encoded),
              0.02 * static_cast<double>(whole->encoded));
}

TEST(Spherize, FollowsUpOnASlope) {
  const double tilt = 0.35;
  const Eigen::Vector3f up =
      (rotation_from_rpy(0.0, tilt, 0.0).transpose() * Eigen::Vector3d::UnitZ()).cast<float>();
  const auto level = spherize(dense_map(), Eigen::Vector3f::UnitZ(), {});
  const auto tilted = spherize(dense_map(tilt), up, {});
  ASSERT_TRUE(level && tilted);
  EXPECT_NEAR(static_cast<double>(tilted->ground), static_cast<double>(level->ground),
              0.05 * static_cast<double>(level->ground));
}

TEST(Spherize, CanKeepSparseGround) {
  SpherizeConfig config;
  config.ground_voxel_m = 2.0f;
  const auto with = spherize(dense_map(), Eigen::Vector3f::UnitZ(), config);
  ASSERT_TRUE(with);
  const auto low = std::count_if(with->decoded.points.begin(), with->decoded.points.end(),
                                 [](const auto& p) { return p.z() < -1.1f; });
  EXPECT_GT(low, 500);
  EXPECT_LE(with->bytes.size(), 25'000u);
}

TEST(Spherize, SameMapSameBytes) {
  const PointCloud map = dense_map();
  EXPECT_EQ(spherize(map, Eigen::Vector3f::UnitZ(), {})->bytes,
            spherize(map, Eigen::Vector3f::UnitZ(), {})->bytes);
}

TEST(Spherize, NothingLeftIsAnEmptyCloudAndBadInputIsCounted) {
  PointCloud map;
  map.points = {{100, 0, 0}, {NAN, 0, 0}};
  const auto result = spherize(map, Eigen::Vector3f::UnitZ(), {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->refused, 1u);
  EXPECT_EQ(result->encoded, 0u);
  EXPECT_TRUE(cloud::decode(result->bytes)->empty());
}

TEST(Spherize, BadConfigAndUpAreNamed) {
  SpherizeConfig config;
  config.radius_m = -1.0f;
  EXPECT_THAT(spherize(PointCloud{}, Eigen::Vector3f::UnitZ(), config).error().message,
              ::testing::HasSubstr("radius_m"));
  EXPECT_THAT(spherize(PointCloud{}, Eigen::Vector3f::Zero(), {}).error().message,
              ::testing::HasSubstr("up"));
}

}  // namespace
}  // namespace fleetmap::registration
