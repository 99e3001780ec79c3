#include "rejection/linearised_candidate.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/symmetric.hpp"
#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

constexpr double kPairGate = 27.9;  // chi squared, six degrees of freedom, 1e-4

}  // namespace

LinearisedCandidate linearise(std::span<const Candidate> all, std::size_t index, const SolvedGraph& solved) {
  const Candidate& candidate = all[index];
  const BetweenFactor& factor = candidate.factor;
  const RelativeResidual r = relative_residual(solved.estimate, factor.a, factor.b, factor.T_a_b);
  LinearisedCandidate result;
  result.candidate = index;
  result.alignment = candidate.alignment;
  result.e = r.e;
  result.z = solved.solver.sensitivity(factor.a, factor.b, r.H_a, Matrix6d::Identity());
  result.S = BlockCholesky::inner(result.z, result.z) + inflated_covariance(factor);
  const CholeskyOf cholesky(result.S);
  result.S_inverse = cholesky.inverse();
  result.cost = result.e.dot(result.S_inverse * result.e) + cholesky.log_det();
  result.B.topRows<3>() = candidate.sign * solved.estimate.T_enu[factor.b].linear().transpose();
  result.B.bottomRows<3>().setZero();
  return result;
}

std::vector<LinearisedCandidate> linearise(std::span<const Candidate> all,
                                           std::span<const std::size_t> indices, const SolvedGraph& solved) {
  std::vector<LinearisedCandidate> result;
  result.reserve(indices.size());
  for (const std::size_t c : indices) result.push_back(linearise(all, c, solved));
  return result;
}

CrossCovariances cross_covariances(std::span<const LinearisedCandidate> candidates) {
  CrossCovariances cross(candidates.size());
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      cross[a].push_back(BlockCholesky::inner(candidates[a].z, candidates[b].z));
  }
  return cross;
}

bool ConditionalResidual::is_consistent() const { return distance < kPairGate; }

ConditionalResidual conditional_residual(const LinearisedCandidate& a, const LinearisedCandidate& b,
                                         const Matrix6d& S_ba) {
  const Matrix6d gain = S_ba * a.S_inverse;
  const Vector6d e = b.e - gain * a.e;
  const Matrix6d S = b.S - gain * S_ba.transpose();
  const CholeskyOf cholesky(S);
  const double distance = cholesky.squared_distance(e);
  return {distance, distance + cholesky.log_det(), std::sqrt(S.diagonal().head<3>().maxCoeff())};
}

std::size_t position_on_track(const Candidate& candidate) {
  return std::min(candidate.factor.a, candidate.factor.b);
}

Indices evenly_spaced(std::span<const std::size_t> indices, std::size_t count) {
  Indices some;
  count = std::min(indices.size(), count);
  for (std::size_t k = 0; k < count; ++k) some.push_back(indices[k * indices.size() / count]);
  return some;
}

}  // namespace fleetmap::graph
