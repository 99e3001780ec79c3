// The covariances of nodes and alignments after encoding and decoding.
#include "covariance_root.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::id;
using fleet_codec::testing::RandomMessages;

TEST(CovarianceRoot, UnknownUncertaintyBecomesTheLargest) {
  graph::Node node;
  node.id = {id("r1"), 0};
  node.G.emplace().covariance.setConstant(std::nan(""));
  const auto received = quantised(node);
  ASSERT_TRUE(received) << received.error().message;
  EXPECT_GT(received->G->covariance(0, 0), 1e10);
  EXPECT_EQ(received->G->covariance(0, 1), 0.0);
  EXPECT_GT(received->G->covariance(5, 5), 30.0);
}

/// A long weak axis in any direction, as along a row of panels: 1 m to 4 m against centimetres.
Matrix6d degenerate_covariance(RandomMessages& random) {
  Vector6d weak, stddev;
  for (int k = 0; k < 6; ++k) {
    weak(k) = random.real(-1.0, 1.0);
    stddev(k) = random.real(0.01, 0.05);
  }
  weak *= std::exp(random.real(0.0, 1.4)) / weak.norm();
  return Matrix6d(stddev.cwiseAbs2().asDiagonal()) + weak * weak.transpose();
}

TEST(CovarianceRoot, CovarianceKeepsItsShapeHoweverLongItsWeakAxis) {
  RandomMessages random(6);
  for (int k = 0; k < 2000; ++k) {
    graph::Node node = random.node();
    node.odom_covariance = degenerate_covariance(random);
    const auto received = quantised(node);
    ASSERT_TRUE(received) << received.error().message;
    const auto again = quantised(*received);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(again->odom_covariance.isApprox(received->odom_covariance, 1e-12)) << "round " << k;
    // Relative to the covariance itself: every axis keeps its length, also those that are short.
    const Eigen::LLT<Matrix6d> root(node.odom_covariance);
    const Matrix6d whitened =
        root.matrixL().solve(Matrix6d(root.matrixL().solve(received->odom_covariance).transpose()));
    const Vector6d ratios = Eigen::SelfAdjointEigenSolver<Matrix6d>(whitened).eigenvalues();
    EXPECT_GT(ratios.minCoeff(), 0.5) << "round " << k;
    EXPECT_LT(ratios.maxCoeff(), 2.0) << "round " << k;
  }
}

TEST(CovarianceRoot, InvalidCovarianceCountsAsUnknown) {
  RandomMessages random(7);
  Matrix6d no_number = Matrix6d::Identity(), negative = no_number, beyond = no_number;
  no_number(3, 3) = std::nan("");
  negative(2, 2) = -1.0;
  beyond(0, 1) = beyond(1, 0) = 1.1;
  for (const Matrix6d& bad : {no_number, negative, beyond, Matrix6d(1e300 * Matrix6d::Identity())}) {
    graph::Alignment alignment = random.alignment();
    alignment.modes.front().covariance = bad;
    const auto received = quantised(alignment);
    ASSERT_TRUE(received) << received.error().message;
    EXPECT_TRUE(received->best().covariance.isApprox(1e4 * Matrix6d::Identity(), 1e-3));
  }
}

}  // namespace
}  // namespace fleetmap::fleet_codec
