#include "registration/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "registration/made_world.hpp"
#include "registration/prepared.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector3d;
using testing::MadeWorld;
using testing::prepared;

Pose shift(double x, double y) { return make_pose(Eigen::Quaterniond::Identity(), Vector3d(x, y, 0)); }

/// Two scans of one place, `T` apart.
struct TwoScans {
  Pose T = make_pose(rotation_from_rpy(0, 0, 0.5), Vector3d(4, -2, 0));
  PreparedCloud target = prepared(scan(Pose::Identity(), 1)), source = prepared(scan(T, 2));

  static cloud::PointCloud scan(const Pose& T, unsigned seed) {
    return MadeWorld(7).scan(make_pose(Eigen::Quaterniond::Identity(), Vector3d(0, 0, 1)) * T, 12'000, 0.02,
                             seed, 30.0);
  }
  Fit fit_at(const Pose& T_target_source) const {
    return compare(*target.data(), *source.data(), T_target_source, {});
  }
};

Fit fit_of(std::vector<float> misfit, std::vector<std::uint16_t> observed) {
  Fit fit;
  fit.misfit = std::move(misfit);
  fit.observed = std::move(observed);
  return fit;
}

TEST(Comparison, TheRightPoseScoresBest) {
  const TwoScans scans;
  const Fit right = scans.fit_at(scans.T);
  EXPECT_GT(right.score, 0.65);
  EXPECT_GT(right.agreement, 0.8);
  EXPECT_LT(right.rmse, 1.05 * std::hypot(scans.target.data()->noise_m, scans.source.data()->noise_m));
  EXPECT_EQ(right.scored, scans.source.data()->fine.points.size());
  EXPECT_LE(right.inliers, right.overlapping);
  EXPECT_LE(right.overlapping, right.scored);
  const auto coarse_at = [&](const Pose& T) {
    return coarse_misfit(*scans.target.data(), *scans.source.data(), T, {});
  };
  double score = right.score;
  for (const double off : {0.1, 0.3, 1.0}) {
    const Pose T_wrong = shift(off, 0.5 * off) * scans.T;
    const double wrong = scans.fit_at(T_wrong).score;
    EXPECT_LT(wrong, score - 0.05) << off;
    score = wrong;
    // Coarse voxels hardly tell a decimetre.
    EXPECT_GT(coarse_at(T_wrong), coarse_at(scans.T) + (off < 0.2 ? 0.02 : 0.05)) << off;
  }
}

TEST(Comparison, GoesBothWays) {
  const TwoScans scans;
  const Fit forth = scans.fit_at(scans.T);
  const Fit back = compare(*scans.source.data(), *scans.target.data(), scans.T.inverse(), {});
  EXPECT_NEAR(forth.score, back.score, 1e-4);
  const std::size_t patches = scans.source.data()->fine.patch_count;
  ASSERT_EQ(forth.misfit.size(), patches + scans.target.data()->fine.patch_count);
  std::size_t observed = 0;
  for (std::size_t k = 0; k < forth.observed.size(); ++k) {
    const std::size_t mirrored = k < patches ? k + patches : k - patches;
    EXPECT_NEAR(forth.misfit[k], back.misfit[mirrored], 0.02f);
    if (k < patches) observed += forth.observed[k];
  }
  EXPECT_EQ(observed, forth.overlapping) << "those of the source come first";
}

/// Floors agree wherever they are laid: what stands on them decides.
TEST(Comparison, FloorsAgreeAtAnyPose) {
  cloud::PointCloud cloud;
  for (double x = -15.0; x < 15.0; x += 0.2) {
    for (double y = -15.0; y < 15.0; y += 0.2) cloud.points.push_back(Vector3d(x, y, 0.0).cast<float>());
    for (double z = 0.1; z < 3.0; z += 0.2) cloud.points.push_back(Vector3d(x, 5.0, z).cast<float>());
  }
  const PreparedCloud flat = prepared(cloud);
  const Fit right = compare(*flat.data(), *flat.data(), Pose::Identity(), {});
  EXPECT_GT(right.agreement, 0.9);
  const Fit wrong = compare(*flat.data(), *flat.data(), shift(0.0, 4.0), {});
  EXPECT_GT(static_cast<double>(wrong.inliers) / static_cast<double>(wrong.overlapping), 0.8);
  EXPECT_LT(wrong.agreement, 0.2);
}

TEST(Comparison, UnobservedPointsDoNotCount) {
  const TwoScans scans;
  const Fit apart = scans.fit_at(shift(500, 0));
  EXPECT_EQ(apart.overlapping, 0u);
  EXPECT_EQ(apart.inliers, 0u);
  EXPECT_EQ(apart.score, 0.0);
  EXPECT_EQ(apart.agreement, 0.0);
  EXPECT_EQ(apart.rmse, 0.0);
  EXPECT_EQ(coarse_misfit(*scans.target.data(), *scans.source.data(), shift(500, 0), {}), 1.0);
  const Fit partly = scans.fit_at(shift(30, 0) * scans.T);
  EXPECT_GT(partly.overlapping, 0u);
  EXPECT_LT(partly.overlapping, partly.scored * 8 / 10);
}

/// At its edges a surface is some centimetres off itself whatever its noise, so squares are subtracted.
TEST(Comparison, TheNoiseIsTheDistanceOfACloudFromItself) {
  double squares = 0.0;
  for (const double sigma : {0.01, 0.03}) {
    std::mt19937 random(1);
    std::normal_distribution<double> gauss(0.0, sigma);
    cloud::PointCloud cloud;
    for (double x = -10.0; x < 10.0; x += 0.15) {
      for (double y = -10.0; y < 10.0; y += 0.15)
        cloud.points.push_back(Vector3d(x, y, gauss(random)).cast<float>());
    }
    const PreparedCloud ground = prepared(cloud);
    const double noise = noise_of(*ground.data(), {});
    EXPECT_GT(noise, 0.9 * sigma);
    squares = noise * noise - squares;
    EXPECT_EQ(noise, ground.data()->noise_m);
    EXPECT_EQ(noise, compare(*ground.data(), *ground.data(), Pose::Identity(), {}).rmse);
  }
  EXPECT_NEAR(squares, 0.03 * 0.03 - 0.01 * 0.01, 8e-5);
}

/// The differences are 0.4 and 0.2: (0.6)^2 / (2 * (0.16 + 0.04)).
TEST(Evidence, IsHalfTheSquareOfTheNormalisedSum) {
  const Fit a = fit_of({0.1f, 0.2f}, {10, 3}), b = fit_of({0.5f, 0.4f}, {3, 10});
  EXPECT_NEAR(evidence(a, b, std::nullopt), 0.9, 1e-6);
  EXPECT_NEAR(evidence(b, a, std::nullopt), -0.9, 1e-6);
  EXPECT_EQ(evidence(a, a, std::nullopt), 0.0);
  const Fit opposite = fit_of({0.5f, 0.6f}, {10, 10}), even = fit_of({0.6f, 0.5f}, {10, 10});
  EXPECT_NEAR(evidence(opposite, even, std::nullopt), 0.0, 1e-6);
}

/// n patches that differ alike give n / 2, however little they differ.
TEST(Evidence, GrowsWithThePatchesThatAgree) {
  for (const std::size_t patches : {1u, 10u, 100u}) {
    for (const float difference : {0.01f, 0.5f}) {
      const Fit a = fit_of(std::vector<float>(patches, 0.2f), std::vector<std::uint16_t>(patches, 9));
      const Fit b =
          fit_of(std::vector<float>(patches, 0.2f + difference), std::vector<std::uint16_t>(patches, 9));
      EXPECT_NEAR(evidence(a, b, std::nullopt), 0.5 * static_cast<double>(patches), 1e-3);
    }
  }
}

TEST(Evidence, APatchSeenAtOnePoseOnlyIsComparedWithChanceOrLeftOut) {
  const Fit a = fit_of({0.1f, 0.2f, 0.0f}, {10, 10, 2}), b = fit_of({0.5f, 0.0f, 0.9f}, {10, 2, 2});
  EXPECT_NEAR(evidence(a, b, std::nullopt), 0.5, 1e-6) << "the first patch alone";
  // The second one is 0.2 against 0.8; the third was hardly observed at all.
  EXPECT_NEAR(evidence(a, b, 0.8), 0.5 * 1.0 * 1.0 / (0.16 + 0.36), 1e-6);
  EXPECT_NEAR(evidence(a, b, 0.2), 0.5, 1e-6) << "no better than chance";
}

}  // namespace
}  // namespace fleetmap::registration
