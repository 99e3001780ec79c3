#include "registration/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "registration/made_world.hpp"
#include "registration/prepared.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector3d;
using testing::error_between;
using testing::level_pose;
using testing::MadeWorld;
using testing::prepared;

Pose turn(const Eigen::Matrix3d& R) { return make_pose(R, Vector3d(0, 0, 0)); }

std::vector<FoundMode> modes_of(const PreparedCloud& target, const PreparedCloud& source,
                                const std::optional<Prior>& prior) {
  return find_modes(*target.data(), *source.data(), {}, prior, {});
}

Prior prior_at(const Pose& T, double sigma_m) {
  Prior prior;
  prior.T_target_source = T;
  prior.sigma_translation_m = sigma_m;
  return prior;
}

/// A row of equal tables 4 m apart on level ground, as seen around `middle`.
cloud::PointCloud row(const Vector3d& middle, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0.0, 0.02);
  cloud::PointCloud cloud;
  const auto add = [&](double x, double y, double z) {
    const Vector3d p = Vector3d(x, y, z) - middle + Vector3d(gauss(random), gauss(random), gauss(random));
    if (p.norm() < 20.0) cloud.points.push_back(p.cast<float>());
  };
  for (double x = -40.0; x < 40.0; x += 0.3) {
    for (double y = -8.0; y < 8.0; y += 0.3) add(x, y, 0.0);
  }
  for (double foot = -40.0; foot < 40.0; foot += 4.0) {
    for (double a = 0.0; a < 1.5; a += 0.12) {
      for (double z = 0.1; z < 1.5; z += 0.12) add(foot + a, 3.0, z), add(foot, 3.0 + a, z);
      for (double b = 0.0; b < 1.5; b += 0.12) add(foot + a, 3.0 + b, 1.5);
    }
  }
  return cloud;
}

void expect_ordered(const std::vector<FoundMode>& modes) {
  double sum = 0.0;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    sum += modes[k].weight;
    if (k > 0) {
      EXPECT_LE(modes[k].weight, modes[k - 1].weight);
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

/// The scene repeats every 4 m, so each shift by so much fits.
TEST(Modes, EveryPoseThatFitsIsFound) {
  const PreparedCloud target = prepared(row({0, 0, 1}, 1)), source = prepared(row({1, 0, 1}, 2));
  const auto modes = modes_of(target, source, prior_at(level_pose(1, 0, 0, 0), 2.5));
  ASSERT_GE(modes.size(), 3u);
  expect_ordered(modes);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d p = modes[k].T_level.translation();
    EXPECT_NEAR(std::remainder(p.x() - 1.0, 4.0), 0.0, 0.1) << k;
    EXPECT_NEAR(p.y(), 0.0, 0.1) << k;
    EXPECT_LT(modes[0].weight, 0.9999) << "none is certain";
    for (std::size_t other = 0; other < k; ++other)
      EXPECT_GT((modes[other].T_level.translation() - p).norm(), 3.0) << "each once";
  }
}

TEST(Modes, ThePriorBoundsWhereTheyMayBeAndWeighsThem) {
  const PreparedCloud target = prepared(row({0, 0, 1}, 1)), source = prepared(row({1, 0, 1}, 2));
  for (const double shift : {-4.0, 0.0, 4.0}) {
    const Prior narrow = prior_at(level_pose(1.0 + shift, 0, 0, 0), 0.5);
    const auto modes = modes_of(target, source, narrow);
    ASSERT_FALSE(modes.empty()) << shift;
    expect_ordered(modes);
    EXPECT_GT(modes[0].weight, 0.999);
    EXPECT_NEAR(modes[0].T_level.translation().x(), 1.0 + shift, 0.1);
    for (const FoundMode& mode : modes)
      EXPECT_TRUE(agrees(narrow, mode.T_level, RegistrationConfig{}.prior_sigmas));
    EXPECT_NEAR(modes[0].log_prior, 0.0, 0.5) << "it is where it was expected";
  }
  const auto none = modes_of(target, source, prior_at(level_pose(500, 0, 0, 0), 0.5));
  EXPECT_TRUE(none.empty());
}

/// Both clouds stand tilted: modes are between their levelled frames, and heights come from the floors.
TEST(Modes, AreBetweenLevelledFrames) {
  const MadeWorld world(11);
  const Pose tilt_target = turn(rotation_from_rpy(0.15, -0.1, 0)),
             tilt_source = turn(rotation_from_rpy(-0.1, 0.2, 0));
  const Pose T_level = level_pose(5, -3, 0.4, 2.0), at_target = level_pose(0, 0, 1.2, 0.3);
  const Vector3d up_target = tilt_target.inverse() * Vector3d::UnitZ();
  const PreparedCloud target = prepared(world.scan(at_target * tilt_target, 12'000, 0.02, 1), up_target);
  const PreparedCloud source = prepared(world.scan(at_target * T_level * tilt_source, 12'000, 0.02, 2),
                                        tilt_source.inverse() * Vector3d::UnitZ());
  Prior prior = prior_at(tilt_target.inverse() * T_level * tilt_source, 2.0);
  prior.up_target = up_target;
  const auto modes = modes_of(target, source, prior);
  ASSERT_FALSE(modes.empty());
  expect_ordered(modes);
  // Levelling may turn a cloud about the vertical.
  const Pose expected = turn(target.data()->R_level_cloud) * prior.T_target_source *
                        turn(source.data()->R_level_cloud).inverse();
  EXPECT_LT(error_between(expected, modes[0].T_level).translation_m, 0.05);
  EXPECT_LT(error_between(expected, modes[0].T_level).rotation_rad, 0.004);
  EXPECT_LT(modes[0].icp.covariance.diagonal().head<3>().maxCoeff(), 0.05 * 0.05);
}

}  // namespace
}  // namespace fleetmap::registration
