#include "motion_prior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace fleetmap::odometry {
namespace {

Matrix12d covariance_of(double pose_variance, double twist_variance) {
  Vector12d diagonal;
  diagonal << Vector6d::Constant(pose_variance), Vector6d::Constant(twist_variance);
  return diagonal.asDiagonal();
}

/// Velocity as a random walk: after dt the way errs by dt^2 V + q dt^3 / 3, the velocity by V + q dt, however
/// little was known of the velocity before. A prior that takes it for known is too sure of ways nobody saw.
TEST(MotionPrior, TheWayIsAsUncertainAsTheVelocityMakesIt) {
  LoamConfig config;
  const double q = config.linear_acceleration * config.linear_acceleration * 0.1;
  constexpr double kPoseVariance = 0.003 * 0.003;
  MotionState previous;
  previous.twist.x() = 1.0;
  for (const double dt : {0.05, 0.1, 0.5}) {
    for (const double variance : {1e-6, 0.01, 1.0, 25.0}) {
      const MotionPrior prior(config, previous, covariance_of(0.0, variance), dt);
      const Matrix12d covariance = prior.linearised(prior.predicted()).H.inverse();
      const double way = dt * dt * variance + q * dt * dt * dt / 3.0 + kPoseVariance;
      EXPECT_NEAR(covariance(0, 0) / way, 1.0, 1e-6) << dt << " s, " << variance;
      EXPECT_NEAR(covariance(6, 6) / (variance + q * dt), 1.0, 1e-6) << dt << " s, " << variance;
    }
  }
}

/// The prediction is the mode of the prior.
TEST(MotionPrior, ThePredictionIsItsMode) {
  MotionState previous;
  previous.twist << 1.0, 0.1, 0.0, 0.0, 0.1, 0.5;
  MotionPrior prior(LoamConfig{}, previous, covariance_of(1e-4, 0.3), 0.1);
  prior.set_forward_speed(1.4, 0.1);
  prior.set_yaw_rate(0.2, 0.05);
  EXPECT_LT(prior.linearised(prior.predicted()).g.norm(), 1e-6);
}

/// The uncertainty of the last pose carries over: an error to the left becomes one ahead after a quarter turn
/// to the left, and an error of the heading becomes one to the side after some distance.
TEST(MotionPrior, TheLastPoseIsKnownNoBetterThanItWas) {
  MotionState previous;
  Matrix12d covariance = covariance_of(0.0, 1e-9);
  covariance(1, 1) = 0.04 * 0.04;
  const MotionPrior::MeasuredRotation left{rotation_from_rpy(0.0, 0.0, 0.5 * std::numbers::pi), 1e-4};
  const MotionPrior turned(LoamConfig{}, previous, covariance, 0.1, left);
  const Matrix12d after_turn = turned.linearised(turned.predicted()).H.inverse();
  EXPECT_NEAR(std::sqrt(after_turn(0, 0)), 0.04, 0.002);
  EXPECT_LT(std::sqrt(after_turn(1, 1)), 0.03);

  previous.twist.x() = 20.0;
  covariance = covariance_of(0.0, 1e-9);
  covariance(5, 5) = 0.02 * 0.02;
  const MotionPrior driven(LoamConfig{}, previous, covariance, 0.1);
  const Matrix12d after_way = driven.linearised(driven.predicted()).H.inverse();
  EXPECT_NEAR(std::sqrt(after_way(1, 1)), 2.0 * 0.02, 0.004);
  EXPECT_LT(std::sqrt(after_way(0, 0)), 0.02);
}

}  // namespace
}  // namespace fleetmap::odometry
