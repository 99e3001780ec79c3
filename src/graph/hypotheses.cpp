#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "alignment_selection.hpp"
#include "expectation.hpp"

namespace fleetmap::graph {
namespace {

// Quantiles of chi squared.
constexpr double kPairGate = 27.9;   // six, 1e-4: one candidate given another
constexpr double kShiftGate = 25.0;  // three, 1.5e-5: all of a hypothesis against the estimate

/// Log odds that a lone accepted registration is right rather than a repetition of the scene. Registrations
/// of one place go wrong together, so n that agree are worth log2(1 + n) of one.
constexpr double kTrust = 6.0;
constexpr std::size_t kMostLookedAt = 16;
constexpr std::size_t kMostJoint = 12;

/// A candidate as the solved graph sees it: its residual is that of an error drawn from S.
struct Seen {
  std::size_t candidate = 0;
  std::size_t alignment = 0;
  Vector6d e;
  BlockCholesky::Sparse z;
  Matrix6d S;  ///< of e: what the graph does not know, and the registration's own error
  Matrix6d S_inverse;
  double cost = 0.0;              ///< -2 log likelihood of e, less a constant
  Eigen::Matrix<double, 6, 3> B;  ///< how e changes when the second frame moves in ENU
};

Seen look(std::span<const Candidate> all, std::size_t index, const GraphSolver& solver,
          const Estimate& estimate) {
  const Candidate& candidate = all[index];
  const Between& between = candidate.between;
  const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
  Seen seen;
  seen.candidate = index;
  seen.alignment = candidate.alignment;
  seen.e = r.e;
  seen.z = solver.sensitivity(between.a, between.b, r.H_a, Matrix6d::Identity());
  seen.S = BlockCholesky::inner(seen.z, seen.z) + judged_covariance(between);
  const Eigen::LLT<Matrix6d> llt(seen.S);
  seen.S_inverse = llt.solve(Matrix6d::Identity());
  seen.cost = seen.e.dot(seen.S_inverse * seen.e) + log_det(llt);
  seen.B.topRows<3>() = candidate.sign * estimate.T_enu[between.b].linear().transpose();
  seen.B.bottomRows<3>().setZero();
  return seen;
}

/// Squared distance of `b` from where `a` lets it be expected.
double distance_given(const Seen& a, const Seen& b, const Matrix6d& S_ba) {
  const Matrix6d gain = S_ba * a.S_inverse;
  const Vector6d e = b.e - gain * a.e;
  const Matrix6d S = b.S - gain * S_ba.transpose();
  return e.dot(S.llt().solve(e));
}

/// Symmetric: who may be right together with whom.
std::vector<std::vector<bool>> consistency(const std::vector<Seen>& seen,
                                           const std::vector<std::vector<Matrix6d>>& S) {
  std::vector<std::vector<bool>> consistent(seen.size(), std::vector<bool>(seen.size(), false));
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (seen[a].alignment == seen[b].alignment) continue;
      consistent[a][b] = consistent[b][a] = distance_given(seen[b], seen[a], S[a][b]) < kPairGate;
    }
  }
  return consistent;
}

/// Greedy clique: the free vertex with the most free neighbours first, then always the one that agrees with
/// all taken and has the most neighbours. Of the modes of one alignment that agree with the others the
/// likeliest: what says little agrees with all.
std::vector<std::size_t> clique(const std::vector<std::vector<bool>>& consistent,
                                const std::vector<Seen>& seen, const std::vector<bool>& free) {
  const std::size_t n = seen.size();
  std::vector<std::size_t> order;
  std::vector<std::size_t> degree(n, 0);
  for (std::size_t a = 0; a < n; ++a) {
    if (!free[a]) continue;
    order.push_back(a);
    for (std::size_t b = 0; b < n; ++b) degree[a] += free[b] && consistent[a][b];
  }
  const auto fit = [&](std::size_t a) { return seen[a].e.dot(seen[a].S_inverse * seen[a].e); };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return degree[a] != degree[b] ? degree[a] > degree[b] : fit(a) < fit(b);
  });
  std::vector<std::size_t> taken;
  for (const std::size_t a : order) {
    if (std::ranges::all_of(taken, [&](std::size_t b) { return consistent[a][b]; })) taken.push_back(a);
  }
  for (std::size_t& member : taken) {
    for (const std::size_t other : order) {
      if (seen[other].alignment != seen[member].alignment || !(seen[other].cost < seen[member].cost))
        continue;
      const bool agrees =
          std::ranges::all_of(taken, [&](std::size_t b) { return b == member || consistent[other][b]; });
      if (agrees) member = other;
    }
  }
  return taken;
}

/// Squared distance that the estimate must be shifted by, as a whole, for the members to fit.
double shift_of(const std::vector<std::size_t>& members, const std::vector<Seen>& seen,
                const std::vector<std::vector<Matrix6d>>& S) {
  std::vector<std::size_t> some;
  const std::size_t count = std::min(members.size(), kMostJoint);
  for (std::size_t k = 0; k < count; ++k) some.push_back(members[k * members.size() / count]);
  const auto rows = static_cast<Eigen::Index>(6 * some.size());
  Eigen::MatrixXd joint(rows, rows), B(rows, 3);
  Eigen::VectorXd e(rows);
  for (std::size_t a = 0; a < some.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(6 * a);
    e.segment<6>(at) = seen[some[a]].e;
    B.middleRows<6>(at) = seen[some[a]].B;
    joint.block<6, 6>(at, at) = seen[some[a]].S;
    for (std::size_t b = 0; b < a; ++b) {
      const auto bt = static_cast<Eigen::Index>(6 * b);
      const bool lower = some[a] > some[b];
      const Matrix6d& S_ab = lower ? S[some[a]][some[b]] : S[some[b]][some[a]];
      joint.block<6, 6>(at, bt) = lower ? S_ab : Matrix6d(S_ab.transpose());
      joint.block<6, 6>(bt, at) = joint.block<6, 6>(at, bt).transpose();
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(joint);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d right = B.transpose() * llt.solve(e);
  const Eigen::Matrix3d information = B.transpose() * llt.solve(B);
  return right.dot(information.llt().solve(right));
}

}  // namespace

Evaluation evaluate(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                    const GraphSolver& solver, const Estimate& estimate) {
  Evaluation evaluation;
  std::vector<Seen> seen;
  const std::size_t looked_at = std::min(candidates.size(), kMostLookedAt);
  for (std::size_t k = 0; k < looked_at; ++k)
    seen.push_back(look(all, candidates[k * candidates.size() / looked_at], solver, estimate));
  std::vector<std::vector<Matrix6d>> S(seen.size());
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) S[a].push_back(BlockCholesky::inner(seen[a].z, seen[b].z));
  }
  const auto consistent = consistency(seen, S);
  std::vector<bool> free(seen.size(), true);
  // What was not looked at is taken to be like what was.
  const double share =
      static_cast<double>(candidates.size()) / static_cast<double>(std::max<std::size_t>(1, looked_at));
  while (std::ranges::find(free, true) != free.end()) {
    const std::vector<std::size_t> members = clique(consistent, seen, free);
    Hypothesis hypothesis;
    double weight = 0.0;
    for (const std::size_t a : members) {
      free[a] = false;
      hypothesis.members.push_back(seen[a].candidate);
      weight += share / static_cast<double>(all[seen[a].candidate].modes);
    }
    std::ranges::sort(hypothesis.members);
    hypothesis.frames = all[hypothesis.members.front()].frames;
    hypothesis.shift = shift_of(members, seen, S);
    hypothesis.support = kTrust * std::log2(1.0 + weight);
    hypothesis.evidence = hypothesis.support - 0.5 * hypothesis.shift;
    if (hypothesis.shift < kShiftGate) {
      evaluation.hypotheses.push_back(std::move(hypothesis));
    } else {
      evaluation.contradicting.insert(hypothesis.members.begin(), hypothesis.members.end());
    }
  }
  std::ranges::stable_sort(evaluation.hypotheses, std::ranges::greater(), &Hypothesis::evidence);
  return evaluation;
}

}  // namespace fleetmap::graph
