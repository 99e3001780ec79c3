#include "registration/surfel_icp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <initializer_list>
#include <random>

#include "support/points.hpp"

namespace fleetmap::registration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using fleetmap::testing::Points;

/// Square plates across the given axes, at 16 places 16 m apart. Plates of one place do not touch.
Points plates(std::initializer_list<int> normals, float half_edge, float spacing = 0.2f) {
  Points points;
  for (int place = 0; place < 16; ++place) {
    const Vector3f middle(16.0f * static_cast<float>(place % 4) - 23.0f,
                          16.0f * static_cast<float>(place / 4) - 23.0f, 1.0f);
    for (const int normal : normals) {
      const Vector3f corner = middle + 3.0f * Vector3f::Unit(normal);
      for (float a = -half_edge; a < half_edge + 0.01f; a += spacing) {
        for (float b = -half_edge; b < half_edge + 0.01f; b += spacing)
          points.push_back(corner + a * Vector3f::Unit((normal + 1) % 3) +
                           b * Vector3f::Unit((normal + 2) % 3));
      }
    }
  }
  return points;
}

/// Whole plates for the target and their middles for the source, so that no edge tells anything.
SurfelMap whole(std::initializer_list<int> normals) { return SurfelMap(plates(normals, 1.6f), {}); }
Points middles(std::initializer_list<int> normals) { return plates(normals, 0.6f); }

/// The points in the frame of a source that lies at `T_target_source`, with noise.
MovingPoints source_of(const Points& points, const Pose& T_target_source, float noise = 0.0f,
                       unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss(0.0f, 1.0f);
  MovingPoints source;
  source.patch_m = 4.0f;
  const int side = 2 * 16 + 1;
  source.patch_count = static_cast<std::size_t>(side * side);
  const Pose T = T_target_source.inverse();
  for (const Vector3f& p : points) {
    const Vector3f error = Vector3f::NullaryExpr([&](Eigen::Index) { return gauss(random); });
    source.points.push_back((T * p.cast<double>()).cast<float>() + noise * error);
    const Eigen::Vector2i cell =
        (source.points.back().head<2>() / source.patch_m).array().floor().cast<int>() + side / 2;
    source.patches.push_back(static_cast<std::uint16_t>(cell.y() * side + cell.x()));
  }
  return source;
}

const Pose kTruth = make_pose(rotation_from_rpy(0.02, -0.01, 0.3), Vector3d(1.5, -0.8, 0.3));
const Pose kNearby = kTruth * make_pose(rotation_from_rpy(0.004, -0.003, 0.006), Vector3d(0.1, -0.12, 0.08));

Vector6d error_of(const IcpResult& result) { return se3_log(kTruth.inverse() * result.T_target_source); }

TEST(SurfelIcp, LaysPointsOnTheSurfels) {
  const IcpResult result = align(whole({0, 1, 2}), source_of(middles({0, 1, 2}), kTruth), kNearby, {});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.unconstrained, 0);
  EXPECT_LT(error_of(result).head<3>().norm(), 0.001);
  EXPECT_LT(error_of(result).tail<3>().norm(), 0.0001);
}

/// Level plates constrain height, roll and pitch. The other directions are unconstrained and stay unchanged.
TEST(SurfelIcp, StepsInNoDirectionThatNothingConstrains) {
  const Pose truth = make_pose(rotation_from_rpy(0, 0, 0.3), Vector3d(1.5, -0.8, 0));
  const Pose start = make_pose(rotation_from_rpy(0.004, -0.003, 0.31), Vector3d(1.6, -0.9, 0.05));
  const IcpResult result = align(whole({2}), source_of(middles({2}), truth), start, {});
  EXPECT_EQ(result.unconstrained, 3);
  const Vector3d rpy = rpy_from_rotation(result.T_target_source.linear());
  EXPECT_LT(rpy.head<2>().norm(), 1e-4);
  EXPECT_NEAR(rpy.z(), 0.31, 1e-3);
  EXPECT_LT((result.T_target_source.translation() - Vector3d(1.6, -0.9, 0.0)).norm(), 1e-3);
}

TEST(SurfelIcp, WithoutMatchesThePoseStays) {
  const SurfelMap target = whole({0, 1, 2});
  const Pose far = make_pose(rotation_from_rpy(0, 0, 0.1), Vector3d(0, 0, 500));
  for (const MovingPoints& source : {MovingPoints{}, source_of(middles({0, 1, 2}), Pose::Identity())}) {
    const IcpResult result = align(target, source, far, {});
    EXPECT_EQ(result.unconstrained, 6);
    EXPECT_LT((result.T_target_source.matrix() - far.matrix()).norm(), 1e-12);
  }
}

/// A fifth of the points was moved since, all of them to the same side.
TEST(SurfelIcp, PointsOfWhatMovedDoNotCount) {
  Points points = middles({0, 1, 2});
  for (std::size_t i = 0; i < points.size(); i += 5) points[i] += Vector3f(0.3f, 0.25f, 0.35f);
  const IcpResult result = align(whole({0, 1, 2}), source_of(points, kTruth), kNearby, {});
  EXPECT_LT(error_of(result).head<3>().norm(), 0.003);
}

/// A plate that the source saw from its other side is another surface.
TEST(SurfelIcp, SurfacesSeenFromTheOtherSideAreNotMatched) {
  const SurfelMap target = whole({1, 2});
  MovingPoints source = source_of(middles({1, 2}), Pose::Identity());
  for (const Vector3f& p : source.points) {
    const Surfel* own = nullptr;
    target.find({&p, 1}, SurfelMap::Reach::near, &own);
    ASSERT_NE(own, nullptr);
    source.facing.push_back({own->axes[0], own->side, own->planar});
  }
  IcpConfig config;
  config.far_stages = 0;
  const auto unconstrained = [&] { return align(target, source, Pose::Identity(), config).unconstrained; };
  EXPECT_EQ(unconstrained(), 1) << "along x, in which no plate faces";
  for (Facing& facing : source.facing) facing.side = -facing.side;
  EXPECT_EQ(unconstrained(), 6);
  for (Facing& facing : source.facing) facing.normal = -facing.normal;
  EXPECT_EQ(unconstrained(), 1) << "a normal and its opposite are the same";
  for (Facing& facing : source.facing) facing.normal = facing.normal.unitOrthogonal().eval();
  EXPECT_EQ(unconstrained(), 6) << "at a right angle";
}

TEST(SurfelIcp, TheCovarianceIsWhatTheResidualsShow) {
  const SurfelMap target = whole({0, 1, 2});
  IcpConfig config;
  config.min_stddev_m = 1e-6;
  config.min_stddev_rad = 1e-8;
  const DriftModels steady;
  double squared = 0.0;  // errors in standard deviations
  constexpr int kRounds = 100;
  for (unsigned seed = 1; seed <= kRounds; ++seed) {
    const MovingPoints source = source_of(middles({0, 1, 2}), kTruth, 0.02f, seed);
    const IcpResult result = align(target, source, kTruth, config, &steady);
    squared += error_of(result).cwiseAbs2().cwiseQuotient(result.covariance.diagonal()).sum();
  }
  // The covariance comes from 16 places less six parameters, ten degrees of freedom: an error is as a number
  // of Student's distribution, whose variance is 10 / 8.
  EXPECT_GT(squared / (6.0 * kRounds), 1.0);
  EXPECT_LT(squared / (6.0 * kRounds), 2.2);
}

TEST(SurfelIcp, TheCovarianceIsNoLessThanItsFloor) {
  const DriftModels steady;
  const IcpResult result =
      align(whole({0, 1, 2}), source_of(middles({0, 1, 2}), kTruth), kTruth, {}, &steady);
  EXPECT_GE(result.covariance.diagonal().head<3>().minCoeff(), 0.005 * 0.005);
  EXPECT_LT(result.covariance.diagonal().head<3>().maxCoeff(), 1.2 * 0.005 * 0.005);
  EXPECT_GE(result.covariance.diagonal().tail<3>().minCoeff(), 0.0002 * 0.0002);
  EXPECT_LT(result.covariance.diagonal().tail<3>().maxCoeff(), 1.2 * 0.0002 * 0.0002);
}

TEST(SurfelIcp, TheCovarianceIsLargeAlongWhatNothingConstrains) {
  const DriftModels steady;
  const IcpResult result =
      align(whole({0, 2}), source_of(middles({0, 2}), Pose::Identity()), Pose::Identity(), {}, &steady);
  EXPECT_EQ(result.unconstrained, 1);
  EXPECT_NEAR(result.covariance(1, 1), 100.0, 1.0) << "of max_stddev_m";
  EXPECT_LT(result.covariance(0, 0), 0.01 * 0.01);
  EXPECT_LT(result.covariance(2, 2), 0.01 * 0.01);
}

TEST(SurfelIcp, DriftOfEitherMapIsAdded) {
  const SurfelMap target = whole({0, 1, 2});
  const MovingPoints source = source_of(middles({0, 1, 2}), Pose::Identity());
  const DriftModel bends(MapDrift::straight(0.02, 0.001), Eigen::Matrix3d::Identity());
  const auto with = [&](const DriftModels& models) {
    return align(target, source, Pose::Identity(), {}, &models).covariance;
  };
  const Matrix6d none = with({}), one = with({{}, bends}), other = with({bends, {}}),
                 both = with({bends, bends});
  EXPECT_GT(one(0, 0), 4.0 * none(0, 0));
  EXPECT_LT((other - one).norm(), 1e-3 * one.norm()) << "at the same pose both bend alike";
  EXPECT_LT((both - one - other + none).norm(), 1e-3 * one.norm());
}

}  // namespace
}  // namespace fleetmap::registration
