#include "rejection/pairwise_consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "fleetmap/geometry/symmetric.hpp"
#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

// Quantiles of chi squared.
constexpr double kPairGate = 27.9;   // six, 1e-4: one candidate given another
constexpr double kShiftGate = 25.0;  // three, 1.5e-5: all of a hypothesis against the estimate

/// Log odds that a lone accepted registration is right rather than a repetition of the scene. Registrations
/// of one place go wrong together, so n that agree are worth log2(1 + n) of one.
constexpr double kTrust = 6.0;
/// Of a hypothesis as a whole, against another one's: what many have in common makes them all go wrong.
constexpr double kMaxSupport = 24.0;
constexpr std::size_t kMaxCandidates = 16;
/// On each side, of which it is asked whether they agree.
constexpr std::size_t kNeighbours = 2;
constexpr std::size_t kMaxJointCandidates = 12;

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
  const BetweenFactor& between = candidate.between;
  const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
  Seen seen;
  seen.candidate = index;
  seen.alignment = candidate.alignment;
  seen.e = r.e;
  seen.z = solver.sensitivity(between.a, between.b, r.H_a, Matrix6d::Identity());
  seen.S = BlockCholesky::inner(seen.z, seen.z) + inflated_covariance(between);
  const CholeskyOf cholesky(seen.S);
  seen.S_inverse = cholesky.inverse();
  seen.cost = seen.e.dot(seen.S_inverse * seen.e) + cholesky.log_det();
  seen.B.topRows<3>() = candidate.sign * estimate.T_enu[between.b].linear().transpose();
  seen.B.bottomRows<3>().setZero();
  return seen;
}

struct Given {
  double distance = 0.0;  ///< squared, from where the other lets it be expected
  double cost = 0.0;      ///< -2 log likelihood there, less a constant
  double sigma_m = 0.0;   ///< of that place
};

/// `b` if `a` is right.
Given given(const Seen& a, const Seen& b, const Matrix6d& S_ba) {
  const Matrix6d gain = S_ba * a.S_inverse;
  const Vector6d e = b.e - gain * a.e;
  const Matrix6d S = b.S - gain * S_ba.transpose();
  const CholeskyOf cholesky(S);
  const double distance = cholesky.squared_distance(e);
  return {distance, distance + cholesky.log_det(), std::sqrt(S.diagonal().head<3>().maxCoeff())};
}

/// Where on the way of the first frame: whoever computed it, the end there is the lower variable.
std::size_t along(const Candidate& candidate) { return std::min(candidate.between.a, candidate.between.b); }

/// `seen` if the member is right that was made nearest to it, and says most of where it must be.
Given given_nearest(std::span<const Candidate> all, const std::vector<Seen>& members, const Seen& seen) {
  const auto apart = [&](const Seen& member) {
    const std::size_t a = along(all[member.candidate]), b = along(all[seen.candidate]);
    return std::max(a, b) - std::min(a, b);
  };
  const Seen& nearest = *std::ranges::min_element(members, {}, apart);
  return given(nearest, seen, BlockCholesky::inner(seen.z, nearest.z));
}

/// Up to `most` of them, spread.
std::vector<std::size_t> some_of(std::span<const std::size_t> all, std::size_t most) {
  std::vector<std::size_t> some;
  const std::size_t count = std::min(all.size(), most);
  for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
  return some;
}

/// What errors of two seen candidates have in common: [a][b] for b < a.
using Common = std::vector<std::vector<Matrix6d>>;

Common common_errors(const std::vector<Seen>& seen) {
  Common common(seen.size());
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) common[a].push_back(BlockCholesky::inner(seen[a].z, seen[b].z));
  }
  return common;
}

/// Symmetric: who may be right together with whom.
std::vector<std::vector<bool>> consistency(const std::vector<Seen>& seen, const Common& common) {
  std::vector<std::vector<bool>> consistent(seen.size(), std::vector<bool>(seen.size(), false));
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (seen[a].alignment == seen[b].alignment) continue;
      consistent[a][b] = consistent[b][a] = given(seen[b], seen[a], common[a][b]).distance < kPairGate;
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

/// Squared distance that the estimate must be shifted by, each pair of frames as a whole, for all members of
/// all pairs (indices in `seen`) to fit: three degrees of freedom a pair.
double shift_of(const std::vector<std::vector<std::size_t>>& pairs, const std::vector<Seen>& seen,
                const Common& common) {
  std::vector<std::size_t> members;
  std::vector<std::size_t> pair_of;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    members.insert(members.end(), pairs[k].begin(), pairs[k].end());
    pair_of.resize(members.size(), k);
  }
  const auto rows = static_cast<Eigen::Index>(6 * members.size());
  Eigen::MatrixXd joint(rows, rows);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(3 * pairs.size()));
  Eigen::VectorXd e(rows);
  for (std::size_t a = 0; a < members.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(6 * a);
    const Seen& one = seen[members[a]];
    e.segment<6>(at) = one.e;
    B.block<6, 3>(at, static_cast<Eigen::Index>(3 * pair_of[a])) = one.B;
    joint.block<6, 6>(at, at) = one.S;
    for (std::size_t b = 0; b < a; ++b) {
      const auto bt = static_cast<Eigen::Index>(6 * b);
      const std::size_t later = std::max(members[a], members[b]), earlier = std::min(members[a], members[b]);
      const Matrix6d& S = common[later][earlier];
      joint.block<6, 6>(at, bt) = later == members[a] ? S : Matrix6d(S.transpose());
      joint.block<6, 6>(bt, at) = joint.block<6, 6>(at, bt).transpose();
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(joint);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd right = B.transpose() * llt.solve(e);
  const Eigen::MatrixXd information = B.transpose() * llt.solve(B);
  return right.dot(information.llt().solve(right));
}

/// One vote of an alignment on each mode of the other: for it if any of its own agrees, against it if none
/// does, none if it would agree with anything.
void vote_on_each_other(const std::vector<std::pair<std::size_t, Seen>>& some,
                        const std::vector<std::pair<std::size_t, Seen>>& others, std::vector<Vote>& votes) {
  enum class Opinion { against, open, agrees };
  std::vector<Opinion> of_some(some.size(), Opinion::against), of_others(others.size(), Opinion::against);
  for (std::size_t a = 0; a < some.size(); ++a) {
    for (std::size_t b = 0; b < others.size(); ++b) {
      const Seen &x = some[a].second, &y = others[b].second;
      const Given one = given(x, y, BlockCholesky::inner(y.z, x.z));
      if (!(one.distance < kPairGate)) continue;
      const Opinion opinion = one.sigma_m > kCertainM ? Opinion::open : Opinion::agrees;
      of_some[a] = std::max(of_some[a], opinion);
      of_others[b] = std::max(of_others[b], opinion);
    }
  }
  const auto count = [&](const auto& modes, const std::vector<Opinion>& opinions) {
    for (std::size_t k = 0; k < modes.size(); ++k) {
      votes[modes[k].first].agree += opinions[k] == Opinion::agrees;
      votes[modes[k].first].disagree += opinions[k] == Opinion::against;
    }
  };
  count(some, of_some);
  count(others, of_others);
}

}  // namespace

double support_of(double agreeing) { return kTrust * std::log2(1.0 + agreeing); }

std::vector<std::vector<std::size_t>> agreeing(std::span<const Candidate> all,
                                               std::span<const Hypothesis> hypotheses,
                                               std::span<const std::size_t> candidates,
                                               const GraphSolver& solver, const Estimate& estimate) {
  std::vector<std::vector<std::size_t>> found;
  std::vector<std::vector<Seen>> members;
  std::set<std::size_t> looked_at;
  for (const Hypothesis& hypothesis : hypotheses) {
    found.push_back(hypothesis.members);
    looked_at.insert(hypothesis.members.begin(), hypothesis.members.end());
    std::vector<Seen>& seen = members.emplace_back();
    for (const std::size_t c : hypothesis.members) seen.push_back(look(all, c, solver, estimate));
  }
  for (const std::size_t c : candidates) {
    if (looked_at.contains(c)) continue;
    const Seen seen = look(all, c, solver, estimate);
    std::optional<std::size_t> likeliest;
    double least = 0.0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Given given = given_nearest(all, members[k], seen);
      if (!(given.distance < kPairGate) || (likeliest && !(given.cost < least))) continue;
      likeliest = k;
      least = given.cost;
    }
    if (likeliest) found[*likeliest].push_back(c);
  }
  return found;
}

std::vector<Vote> neighbours_votes(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                                   const GraphSolver& solver, const Estimate& estimate) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) {
    return std::pair(along(all[candidates[k]]), all[candidates[k]].alignment);
  });
  using Modes = std::vector<std::pair<std::size_t, Seen>>;  // of one alignment
  std::vector<Vote> votes(candidates.size());
  std::deque<Modes> before;
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    Modes modes;
    for (; end < order.size(); ++end) {
      if (all[candidates[order[end]]].alignment != all[candidates[order[first]]].alignment) break;
      modes.emplace_back(order[end], look(all, candidates[order[end]], solver, estimate));
    }
    for (const Modes& others : before) vote_on_each_other(others, modes, votes);
    before.push_back(std::move(modes));
    if (before.size() > kNeighbours) before.pop_front();
  }
  return votes;
}

std::vector<Hypothesis> suspects_of(std::span<const Candidate> all, std::span<const Hypothesis> loop,
                                    const GraphSolver& solver, const Estimate& estimate) {
  std::vector<Seen> seen;
  std::vector<std::vector<std::size_t>> members;  // of each hypothesis, in `seen`
  for (const Hypothesis& hypothesis : loop) {
    members.emplace_back();
    for (const std::size_t c : some_of(hypothesis.members, kMaxJointCandidates)) {
      members.back().push_back(seen.size());
      seen.push_back(look(all, c, solver, estimate));
    }
  }
  const Common common = common_errors(seen);
  std::vector<double> likelihood;  // log, that the others are right
  for (std::size_t k = 0; k < loop.size(); ++k) {
    std::vector<std::vector<std::size_t>> others = members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    double& l = likelihood.emplace_back(-0.5 * shift_of(others, seen, common));
    for (std::size_t other = 0; other < loop.size(); ++other)
      if (other != k) l += std::min(loop[other].support, kMaxSupport);
  }
  const double most = std::ranges::max(likelihood);
  std::vector<Hypothesis> suspects;
  for (std::size_t k = 0; k < loop.size(); ++k)
    if (likelihood[k] > most - kMargin) suspects.push_back(loop[k]);
  return suspects;
}

Evaluation evaluate(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                    const GraphSolver& solver, const Estimate& estimate) {
  Evaluation evaluation;
  std::vector<Seen> seen;
  for (const std::size_t c : some_of(candidates, kMaxCandidates))
    seen.push_back(look(all, c, solver, estimate));
  const Common common = common_errors(seen);
  const auto consistent = consistency(seen, common);
  std::vector<bool> free(seen.size(), true);
  // What was not looked at is taken to be like what was.
  const double share =
      static_cast<double>(candidates.size()) / static_cast<double>(std::max<std::size_t>(1, seen.size()));
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
    hypothesis.shift = shift_of({some_of(members, kMaxJointCandidates)}, seen, common);
    hypothesis.support = support_of(weight);
    hypothesis.evidence = hypothesis.support - 0.5 * hypothesis.shift;
    auto& where = hypothesis.shift < kShiftGate ? evaluation.hypotheses : evaluation.rejected;
    where.push_back(std::move(hypothesis));
  }
  std::ranges::stable_sort(evaluation.hypotheses, std::ranges::greater(), &Hypothesis::evidence);
  return evaluation;
}

}  // namespace fleetmap::graph
