#include "registration/drift_model.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <numbers>
#include <utility>

namespace fleetmap::registration {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Stops along x, each with this covariance of the step to it.
MapDrift stops_at(std::initializer_list<std::pair<double, Vector6d>> places) {
  MapDrift drift;
  for (const auto& [x, variances] : places) {
    MapStop stop;
    stop.T_cloud_base.translation().x() = x;
    stop.step_covariance = variances.asDiagonal();
    drift.stops.push_back(stop);
  }
  return drift;
}

/// A patch whose position at `p` is known to 1 m: gradient and displacement are the same number.
PatchInformation patch_at(const Vector3d& p) {
  Eigen::Matrix<double, 3, 6> J;
  J << Matrix3d::Identity(), -skew(p);
  return {p.head<2>(), J.transpose() * J};
}

Matrix6d covariance(const DriftModel& model, const Vector3d& p) {
  return model.gradient_covariance({patch_at(p)}, Matrix6d::Identity());
}

const Vector6d kNone = Vector6d::Zero(), kShift = 0.04 * Vector6d::Unit(0), kTurn = 0.01 * Vector6d::Unit(5);

TEST(DriftModel, AMapFromOneStopDoesNotBend) {
  const DriftModel model(stops_at({{5.0, kShift}}), Matrix3d::Identity());
  EXPECT_TRUE(covariance(model, {100, 0, 0}).isZero());
  EXPECT_TRUE(covariance(DriftModel(), {100, 0, 0}).isZero());
}

/// The share of a patch counts that was seen from beyond the step.
TEST(DriftModel, PointsBeyondAStepShiftWithIt) {
  const DriftModel model(stops_at({{0.0, kNone}, {100.0, kShift}}), Matrix3d::Identity());
  const double near = 1.0 / (1.0 + 100.0 * 100.0 / 36.0), share = 1.0 / (1.0 + near);
  EXPECT_NEAR(covariance(model, {100, 0, 0})(0, 0), share * share * 0.04, 1e-12);
  EXPECT_NEAR(covariance(model, {0, 0, 0})(0, 0), (1.0 - share) * (1.0 - share) * 0.04, 1e-12)
      << "the frame is that of the stop at the origin";
  EXPECT_NEAR(covariance(model, {50, 0, 0})(0, 0), 0.25 * 0.04, 1e-12) << "half way, from both alike";
  EXPECT_NEAR(covariance(model, {100, 0, 0})(1, 1), 0.0, 1e-12);
}

/// A turn at the stop at 100 m moves what lies 10 m past it by 10 m a radian, and the stop itself not at all.
TEST(DriftModel, ATurnIsAboutTheStopWhereItHappened) {
  const DriftModel model(stops_at({{0.0, kNone}, {100.0, kTurn}}), Matrix3d::Identity());
  const auto share_at = [](double x) {
    const auto weight = [](double d) { return 1.0 / (1.0 + d * d / 36.0); };
    return weight(x - 100.0) / (weight(x) + weight(x - 100.0));
  };
  const double share = share_at(110.0);
  EXPECT_NEAR(covariance(model, {110, 0, 0})(1, 1), share * share * 0.01 * 100.0, 1e-9);
  EXPECT_NEAR(covariance(model, {110, 0, 0})(0, 0), 0.0, 1e-9);
  EXPECT_LT(covariance(model, {100, 0, 0}).norm(), 1e-9);
}

TEST(DriftModel, BendsOnEitherSideOfTheFixedStopMoveTheirSideAlone) {
  const DriftModel model(stops_at({{-100.0, kNone}, {1.0, kShift}, {100.0, 4.0 * kShift}}),
                         Matrix3d::Identity());
  EXPECT_NEAR(covariance(model, {-100, 0, 0})(0, 0), 0.04, 0.001);
  EXPECT_LT(covariance(model, {1, 0, 0})(0, 0), 0.0001);
  EXPECT_NEAR(covariance(model, {100, 0, 0})(0, 0), 0.16, 0.004);
}

/// One bend moves all that lies beyond it at once: two patches add up before they are squared.
TEST(DriftModel, PatchesBehindOneBendMoveTogether) {
  const DriftModel model(stops_at({{0.0, kNone}, {100.0, kShift}}), Matrix3d::Identity());
  const PatchInformation patch = patch_at({100, 0, 0});
  const Matrix6d one = model.gradient_covariance({patch}, Matrix6d::Identity());
  const Matrix6d two = model.gradient_covariance({patch, patch}, Matrix6d::Identity());
  EXPECT_LT((two - 4.0 * one).norm(), 1e-12);
  const Matrix6d twice = model.gradient_covariance({patch}, 2.0 * Matrix6d::Identity());
  EXPECT_LT((twice - 4.0 * one).norm(), 1e-12);
}

/// Levelling that turns the cloud turns all with it.
TEST(DriftModel, IsAboutTheLevelledCloud) {
  const MapDrift drift = stops_at({{0.0, kNone}, {40.0, kShift + kTurn}, {80.0, kTurn}});
  const Matrix3d R = rotation_from_rpy(0.0, 0.0, 0.5 * std::numbers::pi);
  const Vector3d p(70, 5, 1);
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = R;
  const Matrix6d expected = turn * covariance(DriftModel(drift, Matrix3d::Identity()), p) * turn.transpose();
  EXPECT_LT((covariance(DriftModel(drift, R), R * p) - expected).norm(), 1e-9 * expected.norm());
}

TEST(DriftModel, WithoutStopsAStraightPathIsAssumed) {
  const DriftModel assumed(MapDrift{}, Matrix3d::Identity()),
      straight(MapDrift::straight(), Matrix3d::Identity());
  const Matrix6d expected = covariance(straight, {30, 4, 1});
  EXPECT_GT(expected(1, 1), 0.0);
  EXPECT_EQ(covariance(assumed, {30, 4, 1}), expected);
}

}  // namespace
}  // namespace fleetmap::registration
