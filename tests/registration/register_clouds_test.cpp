#include "fleetmap/registration/register_clouds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using testing::error_between;
using testing::kDegree;
using testing::MadeWorld;

struct Pair {
  PointCloud target;
  PointCloud source;
  Pose T_target_source;
};

/// Two scans of one place, `apart_m` and `yaw` apart, each with its own noise, the source a little tilted.
Pair pair_in(const MadeWorld& world, double apart_m, double yaw, unsigned seed, std::size_t count = 15'000) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double bearing = M_PI * unit(random);
  const Pose T_world_target =
      make_pose(rotation_from_rpy(0.05 * unit(random), 0.05 * unit(random), M_PI * unit(random)),
                Eigen::Vector3d(5 * unit(random), 5 * unit(random), 1.2));
  const Pose T_target_source = make_pose(
      rotation_from_rpy(0.08 * unit(random), 0.08 * unit(random), yaw),
      Eigen::Vector3d(apart_m * std::cos(bearing), apart_m * std::sin(bearing), 0.3 * unit(random)));
  return {world.scan(T_world_target, count, 0.03, seed + 1000),
          world.scan(T_world_target * T_target_source, count, 0.03, seed + 2000), T_target_source};
}

TEST(RegisterClouds, FindsThePoseOfOverlappingCloudsWithoutAPrior) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const double apart = 4.0 * seed;  // up to 24 m: about half of each ball is seen by both
    const Pair pair = pair_in(MadeWorld(seed), apart, 0.9 * seed - 3.0, seed);
    const auto result = register_clouds(pair.target, pair.source, {});
    EXPECT_EQ(result.verdict, Verdict::accepted) << "seed " << seed << ": " << result.reason;
    const auto error = error_between(pair.T_target_source, result.T_target_source);
    EXPECT_LT(error.translation_m, 0.08) << "seed " << seed;
    EXPECT_LT(error.rotation_rad, 0.3 * kDegree) << "seed " << seed;
    EXPECT_LT(result.rmse, 0.4);
    EXPECT_EQ(result.modes.front().T_target_source.matrix(), result.T_target_source.matrix());
  }
}

TEST(RegisterClouds, APriorThatIsRightHelpsWhereOverlapIsSmall) {
  for (unsigned seed = 21; seed <= 24; ++seed) {
    const Pair pair = pair_in(MadeWorld(seed), 30.0, 0.4, seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    Prior prior{pair.T_target_source, 2.0, 0.1, 0.05};
    prior.T_target_source.pretranslate(
        Eigen::Vector3d(1.5 * gauss(random), 1.5 * gauss(random), 0.5 * gauss(random)));
    const auto result = register_clouds(pair.target, pair.source, {}, prior);
    const auto error = error_between(pair.T_target_source, result.T_target_source);
    EXPECT_LT(error.translation_m, 0.1) << "seed " << seed << " " << result.reason;
    EXPECT_LT(error.rotation_rad, 0.3 * kDegree) << "seed " << seed;
  }
}

TEST(RegisterClouds, NothingOutsideThePriorIsReturned) {
  const Pair pair = pair_in(MadeWorld(3), 6.0, 0.3, 3);
  Prior wrong{pair.T_target_source, 0.5, 0.05, 0.05};
  wrong.T_target_source.pretranslate(Eigen::Vector3d(20, 0, 0));
  const auto result = register_clouds(pair.target, pair.source, {}, wrong);
  EXPECT_EQ(result.verdict, Verdict::rejected);
  for (const Mode& mode : result.modes) EXPECT_TRUE(agrees(wrong, mode.T_target_source, 4.0));
}

/// The last alignment moves a pose by millimetres, and may carry it over the prior's edge.
TEST(RegisterClouds, NothingIsRefinedOutOfThePrior) {
  const RegistrationConfig config;
  const Pair pair = pair_in(MadeWorld(3), 6.0, 0.3, 3);
  const Pose found =
      register_clouds(pair.target, pair.source, config, Prior{pair.T_target_source}).T_target_source;
  constexpr double kSigma = 0.25;  // m
  std::size_t inside = 0, outside = 0;
  for (int mm = -15; mm <= 15; ++mm) {
    Prior prior{found, kSigma, 0.05, 0.05};
    prior.T_target_source.pretranslate(Eigen::Vector3d(config.prior_sigmas * kSigma + 1e-3 * mm, 0.0, 0.0));
    const auto result = register_clouds(pair.target, pair.source, config, prior);
    for (const Mode& mode : result.modes) {
      EXPECT_TRUE(agrees(prior, mode.T_target_source, config.prior_sigmas + 1e-6)) << mm;
    }
    ++(result.modes.empty() ? outside : inside);
  }
  EXPECT_GT(inside, 5u);
  EXPECT_GT(outside, 5u);
}

TEST(RegisterClouds, SameInputSameBits) {
  const Pair pair = pair_in(MadeWorld(5), 9.0, 1.0, 5);
  const auto a = register_clouds(pair.target, pair.source, {});
  const auto b = register_clouds(pair.target, pair.source, {});
  EXPECT_EQ(a.T_target_source.matrix(), b.T_target_source.matrix());
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.rmse, b.rmse);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t k = 0; k < a.modes.size(); ++k) EXPECT_EQ(a.modes[k].score, b.modes[k].score);
}

TEST(RegisterClouds, CloudsOfDifferentPlacesAreNeverAccepted) {
  for (unsigned seed = 31; seed <= 36; ++seed) {
    const PointCloud target = MadeWorld(seed).scan(Pose::Identity(), 15'000, 0.03, 1);
    const PointCloud source = MadeWorld(seed + 100).scan(Pose::Identity(), 15'000, 0.03, 2);
    for (const bool with_prior : {false, true}) {
      const auto result =
          register_clouds(target, source, {}, with_prior ? std::optional<Prior>(Prior{}) : std::nullopt);
      EXPECT_NE(result.verdict, Verdict::accepted) << "seed " << seed;
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(RegisterClouds, EmptyTinyAndNonFiniteCloudsAreRejected) {
  const PointCloud good = MadeWorld(1).scan(Pose::Identity(), 5'000, 0.03, 1);
  PointCloud tiny;
  tiny.points = {{1, 2, 3}, {4, 5, 6}};
  PointCloud bad;
  bad.points.assign(1000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  PointCloud spot;
  spot.points.assign(1000, Eigen::Vector3f(1, 1, 1));
  PointCloud far = good;
  for (auto& p : far.points) p *= 1e8f;
  for (const PointCloud& cloud : {PointCloud{}, tiny, bad, spot, far}) {
    for (const auto& result : {register_clouds(good, cloud, {}, Prior{}), register_clouds(cloud, good, {})}) {
      EXPECT_NE(result.verdict, Verdict::accepted);
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(RegisterClouds, SomeNonFinitePointsDoNotMatter) {
  Pair pair = pair_in(MadeWorld(6), 5.0, 0.2, 6);
  pair.target.points.resize(pair.target.size() + 100,
                            Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()));
  pair.source.points.insert(pair.source.points.begin(), Eigen::Vector3f::Constant(NAN));
  const auto result = register_clouds(pair.target, pair.source, {});
  EXPECT_LT(error_between(pair.T_target_source, result.T_target_source).translation_m, 0.08) << result.reason;
}

/// Law of a covariance: errors are of the size that it promises.
TEST(RegisterClouds, ErrorsAreOfTheSizeOfTheCovariance) {
  const Drifts none{MapDrift::straight(0.0, 0.0), MapDrift::straight(0.0, 0.0)};
  double nees = 0.0;
  int runs = 0;
  for (unsigned seed = 41; seed <= 56; ++seed) {
    const Pair pair = pair_in(MadeWorld(seed), 6.0, 0.2, seed, 12'000);
    const auto result =
        register_clouds(pair.target, pair.source, {}, Prior{pair.T_target_source, 2.0, 0.1, 0.1}, none);
    if (result.verdict != Verdict::accepted) continue;
    const Vector6d error = se3_log(pair.T_target_source.inverse() * result.T_target_source);
    nees += error.dot(result.covariance.ldlt().solve(error));
    ++runs;
  }
  ASSERT_GE(runs, 12);
  const double mean_nees = nees / runs;  // 6 for a perfect covariance
  RecordProperty("mean_nees", std::to_string(mean_nees));
  EXPECT_GT(mean_nees, 0.3);
  EXPECT_LT(mean_nees, 15.0);
}

/// `cloud` as a robot has it that drove along its x axis with odometry that errs as straight(...) says.
PointCloud bent(const PointCloud& cloud, double sigma_m, double sigma_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  constexpr int kHalf = 40;  // steps of a metre
  std::vector<Pose> T_bent(2 * kHalf + 1, Pose::Identity());
  for (const int direction : {-1, 1}) {
    for (int k = 1; k <= kHalf; ++k) {
      Vector6d twist;
      for (int axis = 0; axis < 6; ++axis) twist[axis] = (axis < 3 ? sigma_m : sigma_rad) * gauss(random);
      const Pose T_cloud_base = make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(direction * k, 0, 0));
      const auto at = [&](int step) { return static_cast<std::size_t>(kHalf + direction * step); };
      T_bent[at(k)] = T_bent[at(k - 1)] * T_cloud_base * se3_exp(twist) * T_cloud_base.inverse();
    }
  }
  PointCloud result = cloud;
  for (auto& p : result.points) {
    const int stop = std::clamp(static_cast<int>(std::lround(p.x())), -kHalf, kHalf);
    p = (T_bent[static_cast<std::size_t>(kHalf + stop)] * p.cast<double>()).cast<float>();
  }
  return result;
}

/// The same law for maps of odometry that drifts, as much as is said and three times as much.
TEST(RegisterClouds, DriftOfTheMapsGoesIntoTheCovariance) {
  for (const double much : {1.0, 3.0}) {
    const double sigma_m = 0.004 * much, sigma_rad = 0.0003 * much;
    const MapDrift drift = MapDrift::straight(sigma_m, sigma_rad);
    std::vector<double> nees;
    for (unsigned seed = 61; seed <= 76; ++seed) {
      const Pair pair = pair_in(MadeWorld(seed), 6.0, 0.2, seed, 12'000);
      const auto result = register_clouds(bent(pair.target, sigma_m, sigma_rad, seed),
                                          bent(pair.source, sigma_m, sigma_rad, seed + 100), {},
                                          Prior{pair.T_target_source, 2.0, 0.1, 0.1}, {drift, drift});
      if (result.modes.empty()) continue;
      const Vector6d error = se3_log(pair.T_target_source.inverse() * result.T_target_source);
      nees.push_back(error.dot(result.covariance.ldlt().solve(error)) / 6.0);
    }
    ASSERT_GE(nees.size(), 12u);
    std::sort(nees.begin(), nees.end());
    const double median = nees[nees.size() / 2];  // 0.89 for a perfect covariance
    RecordProperty("median_nees", std::to_string(median));
    EXPECT_GT(median, 0.2) << much;
    EXPECT_LT(median, 2.5) << much;
  }
}

TEST(RegisterClouds, DriftThatIsNoneIsRefused) {
  const Pair pair = pair_in(MadeWorld(1), 6.0, 0.2, 1);
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
