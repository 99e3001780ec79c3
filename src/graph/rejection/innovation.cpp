#include "rejection/innovation.hpp"

#include <cmath>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::graph {
namespace {

// Registration knows less of its errors than it says; what is too tight would split what agrees.
constexpr double kInflation = 4.0;
constexpr double kFloorM = 0.1;
constexpr double kFloorRad = 0.01;

Innovation judge(const Vector6d& e, const Matrix6d& known, const BetweenFactor& between) {
  const Matrix6d S = known + inflated_covariance(between);
  const CholeskyOf cholesky(S);
  const double distance = cholesky.squared_distance(e);
  return {distance, std::sqrt(known.diagonal().head<3>().maxCoeff()), distance + cholesky.log_det()};
}

}  // namespace

Matrix6d inflated_covariance(const BetweenFactor& between) {
  Matrix6d C = kInflation * between.covariance;
  C.diagonal().head<3>().array() += kFloorM * kFloorM;
  C.diagonal().tail<3>().array() += kFloorRad * kFloorRad;
  return C;
}

Innovation innovation(const BetweenFactor& between, const GraphSolver& solver, const Estimate& estimate) {
  const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
  return judge(r.e, solver.relative_covariance(between.a, between.b, r.H_a), between);
}

Innovation innovation_without(const BetweenFactor& between, const GraphSolver& solver,
                              const Estimate& estimate) {
  const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
  // Information adds up: what the graph knows is what the rest knows and what the tie says.
  const Matrix6d all = CholeskyOf(solver.relative_covariance(between.a, between.b, r.H_a)).inverse();
  const CholeskyOf rest(all - between.information);
  if (!rest.positive_definite()) return {};
  const Matrix6d known = rest.inverse();
  if (!known.allFinite()) return {};
  // What the rest expects: where the solution lies, its pull and the tie's are in balance.
  const Vector6d pull = huber_weight(between, r.e) * (between.information * r.e);
  return judge(r.e + known * pull, known, between);
}

}  // namespace fleetmap::graph
