#include "fleetmap/registration/register_clouds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using testing::error_between;
using testing::MadeWorld;
using testing::scan_pair;
using testing::ScanPair;

TEST(RegisterClouds, NothingOutsideThePriorIsReturned) {
  const ScanPair pair = scan_pair(MadeWorld(3), 6.0, 0.3, 3);
  Prior wrong{pair.T_target_source, 0.5, 0.05, 0.05};
  wrong.T_target_source.pretranslate(Eigen::Vector3d(20, 0, 0));
  const auto result = register_clouds(pair.target, pair.source, {}, wrong);
  EXPECT_EQ(result.verdict, Verdict::rejected);
  for (const Mode& mode : result.modes) EXPECT_TRUE(agrees(wrong, mode.T_target_source, 4.0));
}

TEST(RegisterClouds, SameInputSameBits) {
  const ScanPair pair = scan_pair(MadeWorld(5), 9.0, 1.0, 5);
  const auto a = register_clouds(pair.target, pair.source, {});
  const auto b = register_clouds(pair.target, pair.source, {});
  EXPECT_EQ(a.T_target_source.matrix(), b.T_target_source.matrix());
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.rmse, b.rmse);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t k = 0; k < a.modes.size(); ++k) EXPECT_EQ(a.modes[k].score, b.modes[k].score);
}

TEST(RegisterClouds, EmptyTinyAndNonFiniteCloudsAreRejected) {
  const PointCloud good = MadeWorld(1).scan(Pose::Identity(), 5'000, 0.03, 1);
  PointCloud tiny;
  tiny.points = {{1, 2, 3}, {4, 5, 6}};
  PointCloud bad;
  bad.points.assign(1000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  PointCloud centre;
  centre.points.assign(1000, Eigen::Vector3f(1, 1, 1));
  PointCloud far = good;
  for (auto& p : far.points) p *= 1e8f;
  for (const PointCloud& cloud : {PointCloud{}, tiny, bad, centre, far}) {
    for (const auto& result : {register_clouds(good, cloud, {}, Prior{}), register_clouds(cloud, good, {})}) {
      EXPECT_NE(result.verdict, Verdict::accepted);
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(RegisterClouds, SomeNonFinitePointsDoNotMatter) {
  ScanPair pair = scan_pair(MadeWorld(6), 5.0, 0.2, 6);
  pair.target.points.resize(pair.target.size() + 100,
                            Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()));
  pair.source.points.insert(pair.source.points.begin(), Eigen::Vector3f::Constant(NAN));
  const auto result = register_clouds(pair.target, pair.source, {});
  EXPECT_LT(error_between(pair.T_target_source, result.T_target_source).translation_m, 0.08) << result.reason;
}

TEST(RegisterClouds, DriftThatIsNoneIsRefused) {
  const ScanPair pair = scan_pair(MadeWorld(1), 6.0, 0.2, 1);
  Drifts drifts;
  drifts.source = MapDrift::straight();
  drifts.source.stops[3].step_covariance(2, 2) = std::numeric_limits<double>::quiet_NaN();
  const auto result = register_clouds(pair.target, pair.source, {}, std::nullopt, drifts);
  EXPECT_EQ(result.verdict, Verdict::rejected);
  EXPECT_THAT(result.reason, ::testing::HasSubstr("covariances of steps"));
}

TEST(RegisterClouds, ACorridorLeavesTheDirectionAlongItUncertain) {
  const MadeWorld world = MadeWorld::corridor();
  const Pose T_world_target = make_pose(rotation_from_rpy(0, 0, 0.5), Eigen::Vector3d(0, 0, 1.2));
  const Pose T_world_source = make_pose(rotation_from_rpy(0, 0, 0.6), Eigen::Vector3d(0.5, 0.4, 1.3));
  const Pose T_target_source = T_world_target.inverse() * T_world_source;
  const auto result =
      register_clouds(world.scan(T_world_target, 15'000, 0.03, 1),
                      world.scan(T_world_source, 15'000, 0.03, 2), {}, Prior{T_target_source, 1.0, 0.1, 0.1});
  const Eigen::Vector3d along = T_world_source.linear().transpose() * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d across = T_world_source.linear().transpose() * Eigen::Vector3d::UnitY();
  const Eigen::Matrix3d C = result.covariance.topLeftCorner<3, 3>();
  EXPECT_GT(std::sqrt(along.dot(C * along)), 10.0 * std::sqrt(across.dot(C * across)));
  const Eigen::Vector3d error =
      T_world_source.linear() * (T_target_source.inverse() * result.T_target_source).translation();
  EXPECT_LT(std::abs(error.y()), 0.05);
  EXPECT_LT(std::abs(error.z()), 0.05);
}

TEST(RegistrationConfig, NamesTheFieldAndTheRule) {
  RegistrationConfig config;
  EXPECT_TRUE(config.validate());
  config.voxel_m = -1.0f;
  EXPECT_THAT(config.validate().error().message, ::testing::HasSubstr("voxel_m"));
  EXPECT_THAT(register_clouds(PointCloud{}, PointCloud{}, config).reason, ::testing::HasSubstr("voxel_m"));
  EXPECT_THAT(register_clouds(PointCloud{}, PointCloud{}, {}, Prior{Pose::Identity(), -1.0, 1.0, 1.0}).reason,
              ::testing::HasSubstr("sigma_translation_m"));
}

}  // namespace
}  // namespace fleetmap::registration
