#include "fleetmap/odometry/motion_covariance.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap::odometry {
namespace {

Vector6d gaussian(std::mt19937_64& random, const Vector6d& sigma) {
  std::normal_distribution<double> normal;
  Vector6d v;
  for (int i = 0; i < 6; ++i) v[i] = sigma[i] * normal(random);
  return v;
}

/// Simulated motions err as the covariance says: the mean of e^T C^-1 e is 6.
TEST(MotionCovariance, CoversWhatAccumulatesAndWhatTheEndsAdd) {
  std::mt19937_64 random(5);
  Vector6d step, growth_sigma, noise_sigma;
  step << 0.4, 0.02, 0.0, 0.0, 0.01, 0.05;
  growth_sigma << 2e-3, 1e-3, 1e-3, 2e-4, 2e-4, 4e-4;
  noise_sigma << 8e-3, 4e-3, 2e-3, 4e-4, 4e-4, 6e-4;
  const Matrix6d growth = growth_sigma.cwiseAbs2().asDiagonal();
  const Matrix6d noise = noise_sigma.cwiseAbs2().asDiagonal();
  constexpr int kDrives = 2000, kScans = 40;
  double nees = 0.0;
  for (int drive = 0; drive < kDrives; ++drive) {
    MotionCovariance motion;
    Pose truth = Pose::Identity(), drifting = Pose::Identity(), estimate = Pose::Identity();
    Pose true_start = truth, start = estimate;
    for (int k = 0; k < kScans; ++k) {
      truth = truth * se3_exp(step);
      drifting = drifting * se3_exp(step) * se3_exp(gaussian(random, growth_sigma));
      estimate = drifting * se3_exp(gaussian(random, noise_sigma));
      motion.add(estimate, growth, noise);
      if (k == 7) {
        motion.restart();
        true_start = truth;
        start = estimate;
      }
    }
    const Vector6d e = se3_log((true_start.inverse() * truth).inverse() * (start.inverse() * estimate));
    nees += e.dot(motion.since_reference().ldlt().solve(e)) / kDrives;
  }
  EXPECT_NEAR(nees, 6.0, 0.4);
}

/// A chain of nodes: what was lost from node to node sums, and of how well scans lie in the local map only
/// that of the two ends is left. Twenty times all of it would be three times as uncertain as it is.
TEST(MotionCovariance, OverAChainOfNodesWhatWasLostSums) {
  std::mt19937_64 random(6);
  const Vector6d step = (Vector6d() << 0.1, 0.0, 0.0, 0.0, 0.0, 0.01).finished();
  const Matrix6d growth = 1e-8 * Matrix6d::Identity(), noise = 1e-6 * Matrix6d::Identity();
  const Vector6d growth_sigma = Vector6d::Constant(1e-4), noise_sigma = Vector6d::Constant(1e-3);
  constexpr int kDrives = 1000, kNodes = 20, kScans = 5;
  double nees = 0.0, nees_of_all = 0.0;
  for (int drive = 0; drive < kDrives; ++drive) {
    MotionCovariance motion;
    UncertainPose lost, all;
    Pose truth = Pose::Identity(), drifting = Pose::Identity();
    Pose estimate = se3_exp(gaussian(random, noise_sigma));
    motion.add(estimate, Matrix6d::Zero(), noise);
    const Pose start = estimate;
    for (int node = 0; node < kNodes; ++node) {
      const Pose previous = estimate;
      for (int k = 0; k < kScans; ++k) {
        truth = truth * se3_exp(step);
        drifting = drifting * se3_exp(step) * se3_exp(gaussian(random, growth_sigma));
        estimate = drifting * se3_exp(gaussian(random, noise_sigma));
        motion.add(estimate, growth, noise);
      }
      const Pose T_previous_this = previous.inverse() * estimate;
      lost = compose(lost, {T_previous_this, motion.drift_since_reference()});
      all = compose(all, {T_previous_this, motion.since_reference()});
      motion.restart();
    }
    const Vector6d e = se3_log(truth.inverse() * (start.inverse() * estimate));
    const Matrix6d A = adjoint(estimate.inverse() * start);
    const Matrix6d of_ends = A * noise * A.transpose() + noise;
    nees += e.dot((lost.covariance + of_ends).ldlt().solve(e)) / kDrives;
    nees_of_all += e.dot(all.covariance.ldlt().solve(e)) / kDrives;
  }
  EXPECT_NEAR(nees, 6.0, 0.5);
  EXPECT_LT(nees_of_all, 1.0);
}

TEST(MotionCovariance, StandingAtTheReferenceIsCertain) {
  MotionCovariance motion;
  EXPECT_TRUE(motion.since_reference().isZero());
  motion.add(Pose::Identity(), Matrix6d::Identity(), Matrix6d::Identity());
  EXPECT_TRUE(motion.since_reference().isZero());
  motion.add(Pose::Identity(), Matrix6d::Identity(), Matrix6d::Identity());
  EXPECT_TRUE(motion.since_reference().isApprox(3.0 * Matrix6d::Identity()));
  EXPECT_TRUE(motion.drift_since_reference().isApprox(Matrix6d::Identity()));
  motion.restart();
  EXPECT_TRUE(motion.since_reference().isZero());
}

}  // namespace
}  // namespace fleetmap::odometry
