#include "fleetmap/odometry/motion_prior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace fleetmap::odometry {
namespace {

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
      const MotionPrior prior(config, previous, Vector6d::Constant(variance), dt);
      const Matrix12d covariance = prior.linearised(prior.predicted()).H.inverse();
      const double way = dt * dt * variance + q * dt * dt * dt / 3.0 + kPoseVariance;
      EXPECT_NEAR(covariance(0, 0) / way, 1.0, 1e-6) << dt << " s, " << variance;
      EXPECT_NEAR(covariance(6, 6) / (variance + q * dt), 1.0, 1e-6) << dt << " s, " << variance;
    }
  }
}

/// What is predicted is what the prior finds most likely.
TEST(MotionPrior, ThePredictionIsItsMode) {
  MotionState previous;
  previous.twist << 1.0, 0.1, 0.0, 0.0, 0.1, 0.5;
  MotionPrior prior(LoamConfig{}, previous, Vector6d::Constant(0.3), 0.1);
  prior.set_forward_speed(1.4, 0.1);
  prior.set_yaw_rate(0.2, 0.05);
  EXPECT_LT(prior.linearised(prior.predicted()).g.norm(), 1e-6);
}

}  // namespace
}  // namespace fleetmap::odometry
