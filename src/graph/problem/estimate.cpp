#include "problem/estimate.hpp"

#include <cmath>

namespace fleetmap::graph {
namespace {

/// Squared residuals beyond the 99 % quantile of chi squared with six degrees of freedom are weighted down.
constexpr double kHuber = 16.8;

}  // namespace

RelativeResidual relative_residual(const Estimate& estimate, std::size_t a, std::size_t b,
                                   const Pose& T_a_b) {
  const Pose T_b_a = estimate.T_enu[b].inverse() * estimate.T_enu[a];
  return {-se3_log(T_b_a * T_a_b), -adjoint(T_b_a)};
}

double huber_weight(const BetweenFactor& factor, const Vector6d& e) {
  const double squared = e.dot(factor.information * e);
  return squared > kHuber ? std::sqrt(kHuber / squared) : 1.0;
}

}  // namespace fleetmap::graph
