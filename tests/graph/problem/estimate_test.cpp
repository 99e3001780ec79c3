#include "problem/estimate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fleetmap::graph {
namespace {

TEST(Estimate, TheResidualIsLinearisedByAFiniteDifference) {
  std::mt19937 random(1);
  const auto vector = [&](double sigma) {
    Vector6d v;
    for (int k = 0; k < 6; ++k) v(k) = std::normal_distribution<double>(0.0, sigma)(random);
    return v;
  };
  for (int run = 0; run < 20; ++run) {
    Estimate estimate;
    estimate.T_enu = {se3_exp(vector(1.0)), se3_exp(vector(1.0))};
    // Small residuals, as the linearisation takes the right Jacobian to be the identity.
    const Pose T_a_b = estimate.T_enu[0].inverse() * estimate.T_enu[1] * se3_exp(vector(1e-4));
    const RelativeResidual r = relative_residual(estimate, 0, 1, T_a_b);
    const Vector6d xi_a = vector(1e-5), xi_b = vector(1e-5);
    Estimate moved = estimate;
    moved.T_enu[0] = moved.T_enu[0] * se3_exp(xi_a);
    moved.T_enu[1] = moved.T_enu[1] * se3_exp(xi_b);
    const Vector6d expected = r.e + r.H_a * xi_a + xi_b;
    EXPECT_LT((relative_residual(moved, 0, 1, T_a_b).e - expected).norm(), 1e-7);
  }
}

TEST(Estimate, HuberWeightMakesTheCostGrowLinearly) {
  const BetweenFactor factor(0, 1, Pose::Identity(), Matrix6d::Identity());
  EXPECT_EQ(huber_weight(factor, Vector6d::Constant(0.1)), 1.0);
  const Vector6d e = Vector6d::Constant(10.0);
  EXPECT_LT(huber_weight(factor, e), 1.0);
  EXPECT_NEAR(huber_weight(factor, e) / huber_weight(factor, 2.0 * e), 2.0, 1e-9);
}

}  // namespace
}  // namespace fleetmap::graph
