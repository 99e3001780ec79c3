#include "rejection/innovation.hpp"

#include <cmath>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::graph {
namespace {

constexpr double kInflation = 4.0;
constexpr double kFloorM = 0.1;
constexpr double kFloorRad = 0.01;

Innovation innovation_of(const Vector6d& e, const Matrix6d& predicted, const BetweenFactor& factor) {
  const Matrix6d S = predicted + inflated_covariance(factor);
  const CholeskyOf cholesky(S);
  const double distance = cholesky.squared_distance(e);
  return {distance, std::sqrt(predicted.diagonal().head<3>().maxCoeff()), distance + cholesky.log_det()};
}

}  // namespace

Matrix6d inflated_covariance(const BetweenFactor& factor) {
  Matrix6d C = kInflation * factor.covariance;
  C.diagonal().head<3>().array() += kFloorM * kFloorM;
  C.diagonal().tail<3>().array() += kFloorRad * kFloorRad;
  return C;
}

Innovation innovation(const BetweenFactor& factor, const SolvedGraph& solved) {
  const RelativeResidual r = relative_residual(solved.estimate, factor.a, factor.b, factor.T_a_b);
  return innovation_of(r.e, solved.solver.relative_covariance(factor.a, factor.b, r.H_a), factor);
}

Innovation innovation_without(const BetweenFactor& factor, const SolvedGraph& solved) {
  const RelativeResidual r = relative_residual(solved.estimate, factor.a, factor.b, factor.T_a_b);
  // Information is additive: that of the rest is that of the graph without the factor's.
  const Matrix6d all = CholeskyOf(solved.solver.relative_covariance(factor.a, factor.b, r.H_a)).inverse();
  const CholeskyOf rest(all - factor.information);
  if (!rest.positive_definite()) return {};
  const Matrix6d predicted = rest.inverse();
  if (!predicted.allFinite()) return {};
  // At the solution the gradients of the rest and of the factor cancel.
  const Vector6d gradient = huber_weight(factor, r.e) * (factor.information * r.e);
  return innovation_of(r.e + predicted * gradient, predicted, factor);
}

}  // namespace fleetmap::graph
