// Registration over many made worlds: accuracy, places that differ, and the law of the covariance. Minutes
// under a sanitizer, so the release build runs it; register_clouds_test has the single cases.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <vector>

#include "fleetmap/registration/register_clouds.hpp"
#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using testing::error_between;
using testing::kDegree;
using testing::MadeWorld;
using testing::scan_pair;
using testing::ScanPair;

TEST(RegisteredClouds, FindsThePoseOfOverlappingCloudsWithoutAPrior) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const double apart = 4.0 * seed;  // up to 24 m: about half of each ball is seen by both
    const ScanPair pair = scan_pair(MadeWorld(seed), apart, 0.9 * seed - 3.0, seed);
    const auto result = register_clouds(pair.target, pair.source, {});
    EXPECT_EQ(result.verdict, Verdict::accepted) << "seed " << seed << ": " << result.reason;
    const auto error = error_between(pair.T_target_source, result.T_target_source);
    EXPECT_LT(error.translation_m, 0.08) << "seed " << seed;
    EXPECT_LT(error.rotation_rad, 0.3 * kDegree) << "seed " << seed;
    EXPECT_LT(result.rmse, 0.4);
    EXPECT_EQ(result.modes.front().T_target_source.matrix(), result.T_target_source.matrix());
  }
}

TEST(RegisteredClouds, APriorThatIsRightHelpsWhereOverlapIsSmall) {
  for (unsigned seed = 21; seed <= 24; ++seed) {
    const ScanPair pair = scan_pair(MadeWorld(seed), 30.0, 0.4, seed);
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

TEST(RegisteredClouds, CloudsOfDifferentPlacesAreNeverAccepted) {
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

/// Law of a covariance: errors are of the size that it promises.
TEST(RegisteredClouds, ErrorsAreOfTheSizeOfTheCovariance) {
  const Drifts none{MapDrift::straight(0.0, 0.0), MapDrift::straight(0.0, 0.0)};
  double nees = 0.0;
  int runs = 0;
  for (unsigned seed = 41; seed <= 56; ++seed) {
    const ScanPair pair = scan_pair(MadeWorld(seed), 6.0, 0.2, seed, 12'000);
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
TEST(RegisteredClouds, DriftOfTheMapsGoesIntoTheCovariance) {
  for (const double much : {1.0, 3.0}) {
    const double sigma_m = 0.004 * much, sigma_rad = 0.0003 * much;
    const MapDrift drift = MapDrift::straight(sigma_m, sigma_rad);
    std::vector<double> nees;
    for (unsigned seed = 61; seed <= 76; ++seed) {
      const ScanPair pair = scan_pair(MadeWorld(seed), 6.0, 0.2, seed, 12'000);
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

}  // namespace
}  // namespace fleetmap::registration
