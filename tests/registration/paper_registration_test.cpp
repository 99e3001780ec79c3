// The paper's registration: FPFH, RANSAC, point-to-plane ICP.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "fleetmap/registration/register_clouds.hpp"
#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using testing::error_between;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::MadeWorld;

RegistrationConfig paper() {
  RegistrationConfig config;
  config.method = Method::paper;
  return config;
}

struct Pair {
  PointCloud target, source;
  Pose T_target_source;
};

Pair pair_in(const MadeWorld& world, double apart_m, double yaw) {
  const Pose T_world_target = make_pose(rotation_from_rpy(0.02, -0.01, 0.4), Eigen::Vector3d(2, 1, 1.2));
  const Pose T_target_source =
      make_pose(rotation_from_rpy(-0.03, 0.02, yaw), Eigen::Vector3d(0.8 * apart_m, -0.6 * apart_m, 0.1));
  return {world.scan(T_world_target, 12'000, 0.03, 1001, 25.0),
          world.scan(T_world_target * T_target_source, 12'000, 0.03, 2001, 25.0), T_target_source};
}

TEST(PaperRegistration, FindsThePoseWithoutAPrior) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Pair pair = pair_in(MadeWorld(seed), 2.0 * seed, 1.1 * seed - 2.0);
    const auto result = register_clouds(pair.target, pair.source, paper());
    EXPECT_EQ(result.verdict, Verdict::accepted) << "seed " << seed << ": " << result.reason;
    const auto error = error_between(pair.T_target_source, result.T_target_source);
    EXPECT_LT(error.translation_m, 0.15) << "seed " << seed;
    EXPECT_LT(error.rotation_rad, 0.5 * kDegree) << "seed " << seed;
    ASSERT_EQ(result.modes.size(), 1u);
    EXPECT_EQ(result.modes.front().weight, 1.0);
  }
}

TEST(PaperRegistration, UsesNoPriorAndIsDeterministic) {
  const Pair pair = pair_in(MadeWorld(2), 5.0, 0.7);
  Prior elsewhere;
  elsewhere.T_target_source.translation() = Eigen::Vector3d(30.0, -20.0, 0.0);
  const auto plain = register_clouds(pair.target, pair.source, paper());
  const auto with_prior = register_clouds(pair.target, pair.source, paper(), elsewhere);
  EXPECT_EQ(plain.T_target_source.matrix(), with_prior.T_target_source.matrix());
  EXPECT_EQ(plain.covariance, with_prior.covariance);
  EXPECT_EQ(plain.verdict, with_prior.verdict);
}

/// E_ij (Eq. 2) and its bound of 0.4 m, computed here by brute force.
TEST(PaperRegistration, RmseIsThatOfTheInlierPairs) {
  PointCloud target, moved;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      const auto p = Eigen::Vector3f(
          0.7f * static_cast<float>(x) - 14.0f, 0.7f * static_cast<float>(y) - 14.0f,
          2.0f * std::sin(0.9f * static_cast<float>(x)) * std::cos(0.5f * static_cast<float>(y)));
      target.points.push_back(p);
    }
  }
  const Pose T_target_source = make_pose(rotation_from_rpy(0.0, 0.0, 0.3), Eigen::Vector3d(1.0, 2.0, 0.0));
  moved = transformed(target, T_target_source.inverse());
  RegistrationConfig config = paper();
  config.paper.voxel_m = 0.05f;  // thins nothing
  const auto result = register_clouds(target, moved, config);
  double squares = 0.0;
  std::size_t inliers = 0;
  for (const Eigen::Vector3f& p : transformed(moved, result.T_target_source).points) {
    double min_squared = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3f& q : target.points)
      min_squared = std::min(min_squared, static_cast<double>((p - q).squaredNorm()));
    if (min_squared > 1.0) continue;
    squares += min_squared;
    ++inliers;
  }
  ASSERT_GT(inliers, 0u);
  EXPECT_NEAR(result.rmse, std::sqrt(squares / static_cast<double>(inliers)), 1e-3);
  EXPECT_EQ(result.inliers, inliers);
  config.paper.max_rmse_m = 0.5 * result.rmse;
  const auto refused = register_clouds(target, moved, config);
  EXPECT_EQ(refused.verdict, Verdict::rejected);
  EXPECT_THAT(refused.reason, HasSubstr("E is"));
}

/// In a corridor nothing says where along it one is, and the covariance must say so.
TEST(PaperRegistration, CovarianceIsLargeAlongWhatTheSceneDoesNotConstrain) {
  const Pair pair = pair_in(MadeWorld(3), 4.0, 0.2);
  const Matrix6d rich = register_clouds(pair.target, pair.source, paper()).covariance;
  const MadeWorld corridor = MadeWorld::corridor();
  const PointCloud a = corridor.scan(make_pose(Eigen::Matrix3d::Identity(), {0, 0, 1.2}), 12'000, 0.03, 1);
  const PointCloud b = corridor.scan(make_pose(Eigen::Matrix3d::Identity(), {0, 0, 1.2}), 12'000, 0.03, 2);
  const Matrix6d bare = register_clouds(a, b, paper()).covariance;
  EXPECT_GT(rich.determinant(), 0.0);
  EXPECT_GT(bare(0, 0), 20.0 * bare(1, 1));
  EXPECT_LT(rich(0, 0), 5.0 * rich(1, 1));
}

TEST(PaperRegistration, DifferentPlacesAreRejectedAndSayWhy) {
  const Pose T_world_scan = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 1.2});
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const PointCloud here = MadeWorld(seed).scan(T_world_scan, 12'000, 0.03, 1);
    const PointCloud elsewhere = MadeWorld(seed + 10).scan(T_world_scan, 12'000, 0.03, 2);
    const auto result = register_clouds(here, elsewhere, paper());
    EXPECT_EQ(result.verdict, Verdict::rejected) << "seed " << seed << ", E " << result.rmse;
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(register_clouds(here, here, paper()).verdict, Verdict::accepted) << "seed " << seed;
  }
}

TEST(PaperRegistration, TooSmallOrNonFiniteCloudsAreRejected) {
  const PointCloud here =
      MadeWorld(1).scan(make_pose(Eigen::Matrix3d::Identity(), {0, 0, 1.2}), 12'000, 0.03, 1);
  PointCloud few;
  for (int k = 0; k < 50; ++k) few.points.emplace_back(static_cast<float>(k), 0.0f, 0.0f);
  EXPECT_THAT(register_clouds(here, few, paper()).reason, HasSubstr("points after thinning"));
  EXPECT_THAT(register_clouds(PointCloud{}, here, paper()).reason, HasSubstr("only 0 points"));
  PointCloud broken = here;
  for (std::size_t k = 0; k < broken.size(); k += 2)
    broken.points[k].x() = std::numeric_limits<float>::quiet_NaN();
  const auto result = register_clouds(here, broken, paper());
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.reason;
  EXPECT_LT(error_between(Pose::Identity(), result.T_target_source).translation_m, 0.1);
}

TEST(PaperConfig, NamesTheKeyThatBreaksItsRule) {
  EXPECT_TRUE(PaperConfig{}.validate());
  RegistrationConfig config = paper();
  config.paper.feature_radius_m = 0.1f;
  EXPECT_THAT(config.validate().error().message, HasSubstr("paper.feature_radius"));
}

}  // namespace
}  // namespace fleetmap::registration
