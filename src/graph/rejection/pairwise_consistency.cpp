#include "rejection/pairwise_consistency.hpp"

#include <algorithm>

namespace fleetmap::graph {
namespace {

constexpr double kPriorGate = 25.0;  // chi squared, three degrees of freedom, 1.5e-5
constexpr std::size_t kMaxCandidates = 16;

/// Symmetric adjacency of the consistency graph.
using Consistency = std::vector<std::vector<bool>>;

Consistency pairwise_consistency(std::span<const LinearisedCandidate> candidates,
                                 const CrossCovariances& cross) {
  const std::size_t n = candidates.size();
  Consistency consistent(n, std::vector<bool>(n, false));
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (candidates[a].alignment == candidates[b].alignment) continue;
      consistent[a][b] = consistent[b][a] =
          conditional_residual(candidates[b], candidates[a], cross[a][b]).is_consistent();
    }
  }
  return consistent;
}

/// Free vertices by falling number of free neighbours, then by rising distance to the prior.
Indices by_degree(const Consistency& consistent, std::span<const LinearisedCandidate> candidates,
                  const std::vector<bool>& free) {
  const std::size_t n = candidates.size();
  Indices order;
  std::vector<std::size_t> degree(n, 0);
  for (std::size_t a = 0; a < n; ++a) {
    if (!free[a]) continue;
    order.push_back(a);
    for (std::size_t b = 0; b < n; ++b) degree[a] += free[b] && consistent[a][b];
  }
  const auto distance = [&](std::size_t a) {
    return candidates[a].e.dot(candidates[a].S_inverse * candidates[a].e);
  };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return degree[a] != degree[b] ? degree[a] > degree[b] : distance(a) < distance(b);
  });
  return order;
}

/// Greedy clique of the free vertices. If several modes of one alignment are consistent with the other
/// members, the most likely one replaces the member, because a mode of large covariance is consistent with
/// everything.
Indices greedy_clique(const Consistency& consistent, std::span<const LinearisedCandidate> candidates,
                      const std::vector<bool>& free) {
  const Indices order = by_degree(consistent, candidates, free);
  Indices clique;
  for (const std::size_t a : order) {
    if (std::ranges::all_of(clique, [&](std::size_t b) { return consistent[a][b]; })) clique.push_back(a);
  }
  for (std::size_t& member : clique) {
    for (const std::size_t other : order) {
      if (candidates[other].alignment != candidates[member].alignment ||
          !(candidates[other].cost < candidates[member].cost))
        continue;
      const bool agrees =
          std::ranges::all_of(clique, [&](std::size_t b) { return b == member || consistent[other][b]; });
      if (agrees) member = other;
    }
  }
  return clique;
}

/// `weight`: number of candidates that each member represents.
Hypothesis hypothesis_of(std::span<const Candidate> all, const Indices& clique,
                         std::span<const LinearisedCandidate> candidates, const CrossCovariances& cross,
                         double weight) {
  Hypothesis hypothesis;
  double members = 0.0;
  for (const std::size_t a : clique) {
    hypothesis.members.push_back(candidates[a].candidate);
    members += weight / static_cast<double>(all[candidates[a].candidate].modes);
  }
  std::ranges::sort(hypothesis.members);
  hypothesis.frames = all[hypothesis.members.front()].frames;
  hypothesis.distance =
      squared_distance_to_prior({evenly_spaced(clique, kMaxJointCandidates)}, candidates, cross);
  hypothesis.support = support_of(members);
  hypothesis.evidence = hypothesis.support - 0.5 * hypothesis.distance;
  return hypothesis;
}

/// Conditional distribution of `candidate` given the member of a hypothesis that was measured nearest to it.
ConditionalResidual residual_by_nearest(std::span<const Candidate> all,
                                        std::span<const LinearisedCandidate> members,
                                        const LinearisedCandidate& candidate) {
  const auto separation = [&](const LinearisedCandidate& member) {
    const std::size_t a = position_on_track(all[member.candidate]),
                      b = position_on_track(all[candidate.candidate]);
    return std::max(a, b) - std::min(a, b);
  };
  const LinearisedCandidate& nearest = *std::ranges::min_element(members, {}, separation);
  return conditional_residual(nearest, candidate, BlockCholesky::inner(candidate.z, nearest.z));
}

}  // namespace

ConsistentSets consistent_sets(std::span<const Candidate> all, std::span<const std::size_t> indices,
                               const SolvedGraph& solved) {
  const auto candidates = linearise(all, evenly_spaced(indices, kMaxCandidates), solved);
  const CrossCovariances cross = cross_covariances(candidates);
  const Consistency consistent = pairwise_consistency(candidates, cross);
  const double weight =
      static_cast<double>(indices.size()) / static_cast<double>(std::max<std::size_t>(1, candidates.size()));
  ConsistentSets sets;
  std::vector<bool> free(candidates.size(), true);
  while (std::ranges::find(free, true) != free.end()) {
    const Indices clique = greedy_clique(consistent, candidates, free);
    for (const std::size_t a : clique) free[a] = false;
    Hypothesis hypothesis = hypothesis_of(all, clique, candidates, cross, weight);
    (hypothesis.distance < kPriorGate ? sets.hypotheses : sets.rejected).push_back(std::move(hypothesis));
  }
  std::ranges::stable_sort(sets.hypotheses, std::ranges::greater(), &Hypothesis::evidence);
  return sets;
}

std::optional<Hypothesis> clear_best(const ConsistentSets& sets, const std::set<std::size_t>& excluded) {
  const auto is_excluded = [&](std::size_t c) { return excluded.contains(c); };
  const Hypothesis* best = nullptr;
  for (const Hypothesis& hypothesis : sets.hypotheses) {
    if (std::ranges::any_of(hypothesis.members, is_excluded)) continue;
    if (best != nullptr) {
      if (best->evidence - hypothesis.evidence < kMargin) return std::nullopt;
      break;
    }
    best = &hypothesis;
  }
  if (best == nullptr || best->evidence <= 0.0) return std::nullopt;
  return *best;
}

std::vector<Indices> extended_members(std::span<const Candidate> all, std::span<const Hypothesis> hypotheses,
                                      std::span<const std::size_t> candidates, const SolvedGraph& solved) {
  std::vector<Indices> extended;
  std::vector<std::vector<LinearisedCandidate>> members;
  std::set<std::size_t> assigned;
  for (const Hypothesis& hypothesis : hypotheses) {
    extended.push_back(hypothesis.members);
    assigned.insert(hypothesis.members.begin(), hypothesis.members.end());
    members.push_back(linearise(all, hypothesis.members, solved));
  }
  for (const std::size_t c : candidates) {
    if (assigned.contains(c)) continue;
    const LinearisedCandidate candidate = linearise(all, c, solved);
    std::optional<std::size_t> likeliest;
    double min_cost = 0.0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const ConditionalResidual residual = residual_by_nearest(all, members[k], candidate);
      if (!residual.is_consistent() || (likeliest && !(residual.cost < min_cost))) continue;
      likeliest = k;
      min_cost = residual.cost;
    }
    if (likeliest) extended[*likeliest].push_back(c);
  }
  return extended;
}

}  // namespace fleetmap::graph
