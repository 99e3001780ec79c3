#include "fleetmap/geometry/uncertain_pose.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fleetmap {
namespace {

UncertainPose some_pose(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Matrix6d root;
  for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = unit(random);
  return {make_pose(rotation_from_rpy(unit(random), unit(random), 3.0 * unit(random)),
                    Eigen::Vector3d(10.0 * unit(random), 10.0 * unit(random), unit(random))),
          1e-4 * root * root.transpose()};
}

/// Jacobian of the right tangent of `pose_of(0)` by the tangent of what it is made of, by differences.
template <class PoseOf>
Matrix6d jacobian_of(const PoseOf& pose_of) {
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = kStep * Vector6d::Unit(k);
    J.col(k) = (se3_log(pose_of(Vector6d::Zero()).inverse() * pose_of(step)) -
                se3_log(pose_of(Vector6d::Zero()).inverse() * pose_of(-step))) /
               (2.0 * kStep);
  }
  return J;
}

TEST(UncertainPose, ComposedErrorsAreThoseOfBothToFirstOrder) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const UncertainPose a = some_pose(seed), b = some_pose(seed + 100);
    const UncertainPose c = compose(a, b);
    EXPECT_LT((c.T_a_b.matrix() - a.T_a_b.matrix() * b.T_a_b.matrix()).norm(), 1e-12);
    const Matrix6d by_a = jacobian_of([&](const Vector6d& xi) { return a.T_a_b * se3_exp(xi) * b.T_a_b; });
    const Matrix6d by_b = jacobian_of([&](const Vector6d& xi) { return a.T_a_b * b.T_a_b * se3_exp(xi); });
    const Matrix6d expected = by_a * a.covariance * by_a.transpose() + by_b * b.covariance * by_b.transpose();
    EXPECT_LT((c.covariance - expected).norm(), 1e-6 * expected.norm()) << seed;
  }
}

TEST(UncertainPose, TheInverseErrsAsThePoseDoes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const UncertainPose a = some_pose(seed), back = inverse(a);
    EXPECT_LT((back.T_a_b.matrix() * a.T_a_b.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
    const Matrix6d J = jacobian_of([&](const Vector6d& xi) { return (a.T_a_b * se3_exp(xi)).inverse(); });
    const Matrix6d expected = J * a.covariance * J.transpose();
    EXPECT_LT((back.covariance - expected).norm(), 1e-6 * expected.norm()) << seed;
    EXPECT_LT((inverse(back).covariance - a.covariance).norm(), 1e-9 * a.covariance.norm()) << seed;
  }
}

/// A heading known to 0.01 rad leaves what lies 10 m ahead open by 0.1 m sideways.
TEST(UncertainPose, AnErrorOfTheHeadingGrowsWithTheDistance) {
  UncertainPose turn, ahead;
  turn.covariance(5, 5) = 0.01 * 0.01;
  ahead.T_a_b.translation().x() = 10.0;
  const UncertainPose there = compose(turn, ahead);
  EXPECT_NEAR(there.covariance(1, 1), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(there.covariance(5, 5), 0.01 * 0.01, 1e-15);
  EXPECT_NEAR(there.covariance(1, 5), 0.1 * 0.01, 1e-12);
  EXPECT_NEAR(there.covariance(0, 0), 0.0, 1e-15);
  EXPECT_NEAR(compose(ahead, turn).covariance(1, 1), 0.0, 1e-15) << "a turn at the end moves nothing";
}

TEST(UncertainPose, ComposingIsAssociativeAndTheReverseOfAChainIsTheChainOfReverses) {
  const UncertainPose a = some_pose(1), b = some_pose(2), c = some_pose(3);
  const Matrix6d left = compose(compose(a, b), c).covariance, right = compose(a, compose(b, c)).covariance;
  EXPECT_LT((left - right).norm(), 1e-12 * left.norm());
  const Matrix6d reverse = inverse(compose(a, b)).covariance;
  EXPECT_LT((compose(inverse(b), inverse(a)).covariance - reverse).norm(), 1e-12 * reverse.norm());
}

}  // namespace
}  // namespace fleetmap
