#include "features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "deskew.hpp"
#include "motion_prior.hpp"
#include "rate_history.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

const testing::PoseAt kStill = [](double) { return Pose::Identity(); };

/// A square room seen from its middle: where its walls meet is neither a plane nor an edge.
TEST(Features, CornersOfARoomAreNoFeatures) {
  testing::SyntheticWorld world;
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 5.0)), {5.0, 4.0, 10.0});
  testing::ScanOptions options;
  options.noise = 0.005;
  options.T_base_lidar = Pose::Identity();
  options.T_base_lidar.translation().z() = 5.0;
  LoamConfig config;
  SweepBuilder builder(config, vlp16());
  FeatureExtractor extractor(config);
  const Sweep& sweep = builder.build(make_scan(world, kStill, 0.0, vlp16(), options));
  const Features& features = extractor.extract(sweep);
  EXPECT_TRUE(features.edges.empty());
  EXPECT_GT(features.planes.size(), sweep.points.size() / 2);
  for (const std::uint32_t i : features.planes) {
    const Eigen::Vector2f p = sweep.points[i].position.head<2>().cwiseAbs();
    EXPECT_GT((p - Eigen::Vector2f(5.0f, 4.0f)).norm(), 0.02f);
  }
}

/// A post is at its axis and a board ends where it ends, from whichever side they are seen.
TEST(Features, EdgesLookTheSameFromAllSides) {
  testing::SyntheticWorld world;
  world.add_post({6.0, 0.0}, 0.1, 4.0);
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 6.0, 2.0)), {1.0, 0.02, 2.0});
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 5.0)),
                {15.0, 15.0, 10.0});
  LoamConfig config;
  testing::ScanOptions options;
  options.noise = 0.005;
  config.T_base_lidar = options.T_base_lidar;
  SweepBuilder builder(config, vlp16());
  FeatureExtractor extractor(config);
  for (const double x : {1.0, 6.0, 11.0}) {
    const Eigen::Vector2d eye(x, x == 6.0 ? 4.0 : 1.0);
    const Pose T = make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(eye.x(), eye.y(), 0.0));
    const Sweep& sweep = builder.build(make_scan(
        world, [&](double) { return T; }, 0.0, vlp16(), options));
    Eigen::Vector2d axis = Eigen::Vector2d::Zero(), border = Eigen::Vector2d::Zero();
    int posts = 0, borders = 0;
    for (const FeaturePoint& edge : extractor.extract(sweep).edges) {
      const Eigen::Vector2d p = edge.position.head<2>().cast<double>() + eye;
      if ((p - Eigen::Vector2d(6.0, 0.0)).norm() < 0.3) axis += p, ++posts;
      if ((p - Eigen::Vector2d(1.0, 6.0)).norm() < 0.3) border += p, ++borders;
    }
    ASSERT_GT(posts, 3) << x;
    EXPECT_LT((axis / posts - Eigen::Vector2d(6.0, 0.0)).norm(), 0.025) << x;
    if (x > 2.0) continue;  // from farther to the right the board is seen along itself
    ASSERT_GT(borders, 3) << x;
    EXPECT_LT((border / borders - Eigen::Vector2d(1.0, 6.0)).norm(), 0.04) << x;
  }
}

/// Noise along the rays does not move a post's axis away: that would stretch every way past posts.
TEST(Features, APostLiesAtItsAxisHoweverNoisyTheRanges) {
  testing::SyntheticWorld world;
  constexpr double kDistance = 5.0;
  world.add_post({kDistance, 0.0}, 0.06, 4.0);
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 5.0)),
                {15.0, 15.0, 10.0});
  LoamConfig config;
  testing::ScanOptions options;
  options.noise = 0.03;
  config.T_base_lidar = options.T_base_lidar;
  SweepBuilder builder(config, os1_64());
  FeatureExtractor extractor(config);
  double sum = 0.0;
  int posts = 0;
  for (int turn = 0; turn < 60; ++turn) {  // so that the rays hit it each time elsewhere
    const double yaw = 0.1 * turn;
    const Pose T = make_pose(rotation_from_rpy(0.0, 0.0, yaw), Eigen::Vector3d::Zero());
    const Sweep& sweep = builder.build(make_scan(
        world, [&](double) { return T; }, 0.1 * turn, os1_64(), options));
    for (const FeaturePoint& edge : extractor.extract(sweep).edges) {
      const Eigen::Vector3d p = T * edge.position.cast<double>();
      if ((p.head<2>() - Eigen::Vector2d(kDistance, 0.0)).norm() > 0.3) continue;
      sum += p.x() - kDistance;
      ++posts;
    }
  }
  ASSERT_GT(posts, 500);
  EXPECT_NEAR(sum / posts, 0.0, 0.008);
}

/// Rings and times recovered from the points alone equal the device's own.
TEST(Sweep, RecoversRingsAndTimes) {
  const testing::SyntheticWorld world = testing::yard_world();
  for (const LidarModel& model : {vlp16(), os1_64()}) {
    SweepBuilder with_fields(LoamConfig{}, model), without(LoamConfig{}, model);
    sensor::Scan scan = make_scan(world, kStill, 0.0, model);
    const Sweep& expected = with_fields.build(scan);
    scan.has_ring = scan.has_time = false;
    const Sweep& found = without.build(scan);
    ASSERT_EQ(found.ring_begin, expected.ring_begin) << model.name;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
      ASSERT_NEAR(found.points[i].time, expected.points[i].time, 2e-4) << model.name << " point " << i;
    }
  }
}

/// The series equals the exponential map of the mean velocity since the reference instant.
TEST(SweepMotion, EqualsTheExponentialMap) {
  MotionState state;
  state.twist << 3.0, -0.5, 0.2, 0.3, -0.4, 2.0;
  const Eigen::Vector3d p(12.0, -7.0, 1.5);
  for (const double acceleration : {0.0, 4.0}) {
    state.turn_acceleration << 0.5 * acceleration, acceleration, -acceleration;
    const SweepMotion motion(state.twist, state.turn_acceleration);
    for (const double s : {-0.1, -0.05, 0.0, 0.02, 0.1}) {
      const Eigen::Vector3d exact = state.motion_to(s) * p;
      EXPECT_LT((motion.at_reference(p.cast<float>(), static_cast<float>(s)).cast<double>() - exact).norm(),
                1e-3);
    }
  }
}

/// A steady acceleration seen through a noisy gyro: the slope errs as its variance says.
TEST(RateHistory, TellsTheTrendAndHowWell) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d slope(1.5, -0.7, 0.0);
  double nees = 0.0;
  constexpr int kRounds = 2000;
  for (int round = 0; round < kRounds; ++round) {
    RateHistory gyro;
    for (int k = 0; k <= 20; ++k) {
      const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
      gyro.add(Stamp{k * std::chrono::milliseconds(10)},
               Eigen::Vector3d(1.0, 2.0, 3.0) + 0.01 * k * slope + 0.01 * noise);
    }
    const auto trend =
        gyro.trend(Stamp{std::chrono::milliseconds(50)}, Stamp{std::chrono::milliseconds(250)});
    ASSERT_TRUE(trend);
    nees += (trend->slope - slope).cwiseAbs2().cwiseQuotient(trend->variance).mean() / kRounds;
  }
  EXPECT_NEAR(nees, 14.0 / 12.0, 0.15);  // of Student's distribution with 14 degrees of freedom
  RateHistory few;
  for (int k = 0; k < 4; ++k) few.add(Stamp{k * std::chrono::milliseconds(10)}, slope);
  EXPECT_FALSE(few.trend(Stamp{}, Stamp{std::chrono::seconds(1)}));
}

}  // namespace
}  // namespace fleetmap::odometry
