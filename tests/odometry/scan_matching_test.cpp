#include "scan_matching.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace fleetmap::odometry {
namespace {

using Eigen::Vector3d;

/// Pose of the robot, inside a hall around the map's origin.
const Pose kTruth = make_pose(rotation_from_rpy(0.02, -0.03, 0.4), Vector3d(0.7, -0.4, 0.1));

/// Points on the walls y = -4 and 4, floor and ceiling, and on the walls x = -6 and 6 of a closed hall.
std::vector<Vector3d> hall(double spacing, bool closed) {
  std::vector<Vector3d> points;
  for (double x = -6.0 + 0.5 * spacing; x < 6.0; x += spacing) {
    for (double z = -1.0 + 0.5 * spacing; z < 3.0; z += spacing) {
      for (const double y : {-4.0, 4.0}) points.emplace_back(x, y, z);
    }
    for (double y = -4.0 + 0.5 * spacing; y < 4.0; y += spacing) {
      for (const double z : {-1.0, 3.0}) points.emplace_back(x, y, z);
    }
  }
  for (double y = -4.0 + 0.5 * spacing; closed && y < 4.0; y += spacing) {
    for (double z = -1.0 + 0.5 * spacing; z < 3.0; z += spacing) {
      for (const double x : {-6.0, 6.0}) points.emplace_back(x, y, z);
    }
  }
  return points;
}

/// The points as seen from kTruth by a robot of constant velocity, fired one after the other from
/// `first_time` to `last_time`, with this noise along every axis.
std::vector<FeaturePoint> observed(const std::vector<Vector3d>& points, double noise = 0.0,
                                   const Vector6d& twist = Vector6d::Zero(), double first_time = 0.0,
                                   double last_time = 0.0) {
  std::mt19937 random(4);
  std::normal_distribution<double> gauss(0.0, 1.0);
  std::vector<FeaturePoint> features;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // A prime step spreads the times over the whole hall.
    const double share = static_cast<double>(i * 7919 % points.size()) / static_cast<double>(points.size());
    const double time = first_time + share * (last_time - first_time);
    const Vector3d p = (kTruth * se3_exp(time * twist)).inverse() * points[i];
    const Vector3d error(gauss(random), gauss(random), gauss(random));
    features.push_back({(p + noise * error).cast<float>(), static_cast<float>(time), 0.0f});
  }
  return features;
}

LocalMap map_of(const std::vector<Vector3d>& surfaces) {
  LocalMap map({});
  map.add_surfaces(surfaces, {0.0, 0.0, 1.0});
  return map;
}

/// A prior that knows the pose to some decimetres and degrees, here 0.1 m and 1 degree off.
MotionPrior prior_with(const Vector6d& twist, double twist_sigma) {
  Vector6d off;
  off << 0.1, -0.06, 0.04, 0.005, -0.01, 0.017;
  MotionState before;
  before.T_odom_base = kTruth * se3_exp(off) * se3_exp(-0.1 * twist);
  before.twist = twist;
  Vector12d variances;
  variances << Vector3d::Constant(0.04), Vector3d::Constant(0.01),
      Vector6d::Constant(twist_sigma * twist_sigma);
  return MotionPrior(LoamConfig{}, before, variances.asDiagonal(), 0.1);
}

MatchResult aligned(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                    LocalMap& map, const MotionPrior& prior) {
  return ScanMatcher(LoamConfig{}).align(planes, edges, map, prior, prior.predicted(), 0.5);
}

Vector6d error_of(const MatchResult& result) { return se3_log(kTruth.inverse() * result.state.T_odom_base); }

TEST(ScanMatching, LaysAScanOnTheMap) {
  LocalMap map = map_of(hall(0.15, true));
  const MatchResult result = aligned(observed(hall(0.4, true)), {}, map, prior_with(Vector6d::Zero(), 0.1));
  EXPECT_TRUE(result.converged);
  EXPECT_LT(error_of(result).head<3>().norm(), 0.001);
  EXPECT_LT(error_of(result).tail<3>().norm(), 0.0002);
  EXPECT_EQ(result.degenerate_count, 0);
  EXPECT_GT(result.planes, 500u);
  EXPECT_EQ(result.edges, 0u);
  EXPECT_GT(result.inlier_fraction, 0.99);
  EXPECT_LT(result.rms, 0.002);
  // The walls have an area of 160 m^2, floor and ceiling of 192 m^2.
  const double walls = static_cast<double>(result.upright) / static_cast<double>(result.planes);
  EXPECT_NEAR(walls, 160.0 / 352.0, 0.08);
  EXPECT_GT(result.upright_inliers, result.upright * 98 / 100);
}

/// Noise as assumed gives a variance of unit weight of 1, half of it a quarter.
TEST(ScanMatching, TellsHowTheNoiseComparesWithWhatWasAssumed) {
  LocalMap map = map_of(hall(0.15, true));
  const double assumed = LoamConfig{}.range_noise;
  const MotionPrior prior = prior_with(Vector6d::Zero(), 0.1);
  const MatchResult as_assumed = aligned(observed(hall(0.3, true), assumed), {}, map, prior);
  EXPECT_NEAR(as_assumed.residual_variance, 1.0, 0.12);
  EXPECT_NEAR(as_assumed.rms, assumed, 0.06 * assumed);
  const MatchResult half = aligned(observed(hall(0.3, true), 0.5 * assumed), {}, map, prior);
  EXPECT_NEAR(half.residual_variance, 0.25, 0.03);
  EXPECT_NEAR(half.rms, 0.5 * assumed, 0.03 * assumed);
}

/// Between two walls nothing tells the way along them: there the prior is kept, and said so.
TEST(ScanMatching, FollowsThePriorAlongWhatTheSceneDoesNotConstrain) {
  LocalMap map = map_of(hall(0.15, false));
  const MotionPrior prior = prior_with(Vector6d::Zero(), 0.1);
  const MatchResult result = aligned(observed(hall(0.4, false)), {}, map, prior);
  ASSERT_EQ(result.degenerate_count, 1);
  // Directions are those of the right tangent, in base_link.
  const Vector3d along = kTruth.linear().transpose() * Vector3d::UnitX();
  EXPECT_GT(std::abs(result.degenerate_directions.col(0).head<3>().dot(along)), 0.999);
  const Vector3d p = result.state.T_odom_base.translation();
  EXPECT_NEAR(p.x(), prior.predicted().T_odom_base.translation().x(), 0.004);
  EXPECT_NEAR(p.y(), kTruth.translation().y(), 0.001);
  EXPECT_NEAR(p.z(), kTruth.translation().z(), 0.001);
  EXPECT_LT(error_of(result).tail<3>().norm(), 0.0002);
  Vector6d x = Vector6d::Zero();
  x.head<3>() = along;
  const double information = x.dot(result.lidar_information.topLeftCorner<6, 6>() * x);
  EXPECT_LT(information, 1e-3 * result.lidar_information(2, 2));
}

/// All points of this sweep were fired after the reference instant, the last of them 0.2 m farther on.
TEST(ScanMatching, ThePoseIsThatOfTheReferenceInstant) {
  LocalMap map = map_of(hall(0.15, true));
  Vector6d twist;
  twist << 2.0, 0.1, 0.0, 0.0, 0.0, 0.5;
  std::vector<FeaturePoint> features = observed(hall(0.4, true), 0.0, twist, 0.0, 0.1);
  const MotionPrior prior = prior_with(twist, 0.01);
  const MatchResult result = aligned(features, {}, map, prior);
  EXPECT_LT(error_of(result).head<3>().norm(), 0.003);
  EXPECT_LT(error_of(result).tail<3>().norm(), 0.001);
  EXPECT_LT((result.state.twist - twist).head<3>().norm(), 0.05);
  for (FeaturePoint& feature : features) feature.time = 0.0f;
  EXPECT_NEAR(error_of(aligned(features, {}, map, prior)).x(), 0.1, 0.02) << "where the robot was on average";
}

/// Four posts tell the place and the heading, and no height.
TEST(ScanMatching, EdgesCountAcrossThem) {
  std::vector<Vector3d> posts;
  for (double z = -1.0; z < 2.0; z += 0.05) {
    for (const Vector3d& foot :
         {Vector3d(3.1, 2.1, 0), Vector3d(-3.1, 2.1, 0), Vector3d(-4.1, -3.1, 0), Vector3d(5.1, -2.1, 0)})
      posts.emplace_back(foot + z * Vector3d::UnitZ());
  }
  LocalMap map({});
  map.add_edges(posts);
  const MotionPrior prior = prior_with(Vector6d::Zero(), 0.1);
  const MatchResult result = aligned({}, observed(posts), map, prior);
  EXPECT_EQ(result.planes, 0u);
  EXPECT_GT(result.edges, 150u);
  EXPECT_EQ(result.upright, result.edges);
  const Vector3d p = result.state.T_odom_base.translation();
  EXPECT_LT((p - kTruth.translation()).head<2>().norm(), 0.002);
  EXPECT_NEAR(p.z(), prior.predicted().T_odom_base.translation().z(), 0.01);
  EXPECT_LT(error_of(result).tail<3>().norm(), 0.001);
  EXPECT_EQ(result.degenerate_count, 1);
}

TEST(ScanMatching, WithoutFeaturesOrMapThePriorIsAllThereIs) {
  const MotionPrior prior = prior_with(Vector6d::Zero(), 0.1);
  LocalMap map = map_of(hall(0.15, true)), empty({});
  for (const auto& [features, on] :
       {std::pair{std::vector<FeaturePoint>{}, &map}, std::pair{observed(hall(0.4, true)), &empty}}) {
    const MatchResult result = aligned(features, {}, *on, prior);
    EXPECT_EQ(result.planes + result.edges, 0u);
    EXPECT_EQ(result.inlier_fraction, 0.0);
    EXPECT_EQ(result.degenerate_count, 6);
    EXPECT_LT(se3_log(prior.predicted().T_odom_base.inverse() * result.state.T_odom_base).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace fleetmap::odometry
