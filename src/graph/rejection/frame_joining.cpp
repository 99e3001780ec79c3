#include "rejection/frame_joining.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "fleetmap/geometry/symmetric.hpp"
#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

constexpr int kMaxRounds = 4;
/// Gauss-Newton steps between rounds, whose estimate need not be exact; the last one must converge.
constexpr int kStepsPerRound = 2;
/// Changes of fewer than one accepted alignment in so many end the rounds.
constexpr std::size_t kFewOf = 25;
constexpr double kSingleGate = 16.0;  // chi squared, six degrees of freedom, 1.4e-2
/// Chi squared, three degrees of freedom, 1e-3: of a hypothesis between frames that are connected already.
constexpr double kConnectedPriorGate = 16.3;

/// Union-find over frames.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  bool connects(const FramePair& frames) const { return root(frames.first) == root(frames.second); }
  /// False if they are connected already.
  bool join(const FramePair& frames) {
    const std::size_t a = root(frames.first), b = root(frames.second);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::size_t root(std::size_t k) const {
    while (parent_[k] != k) k = parent_[k];
    return k;
  }
  std::vector<std::size_t> parent_;
};

struct Accepted {
  std::map<std::size_t, std::size_t> candidates;  ///< by alignment
  Components components;
};

Accepted with(Accepted accepted, std::span<const Candidate> candidates, const Hypothesis& hypothesis) {
  for (const std::size_t c : hypothesis.members) accepted.candidates.emplace(candidates[c].alignment, c);
  return accepted;
}

/// Without some alignments, and without the connections that only they made.
Accepted without(const RejectionProblem& problem, Accepted accepted,
                 const std::set<std::size_t>& alignments) {
  if (alignments.empty()) return accepted;
  std::erase_if(accepted.candidates, [&](const auto& one) { return alignments.contains(one.first); });
  accepted.components = Components(problem.graph.frames.size());
  for (const auto& [alignment, c] : accepted.candidates)
    accepted.components.join(problem.candidates[c].frames);
  return accepted;
}

struct Joined {
  Accepted accepted;
  bool connects = false;  ///< frames that were not connected before
};

/// Accepts the clear best hypotheses: between connected frames those that are close to the prior, between
/// others in order of evidence unless they would close a loop, which is decided when the loop is solved.
Joined with_best_hypotheses(const RejectionProblem& problem, Accepted accepted,
                            const std::map<FramePair, ConsistentSets>& sets,
                            const TrialExclusions& exclusions) {
  std::vector<Hypothesis> joining;
  for (const auto& [frames, of_pair] : sets) {
    const std::optional<Hypothesis> best = clear_best(of_pair, exclusions.candidates);
    if (!best) continue;
    if (accepted.components.connects(frames)) {
      if (best->distance < kConnectedPriorGate)
        accepted = with(std::move(accepted), problem.candidates, *best);
    } else if (!exclusions.frames.contains(frames)) {
      joining.push_back(*best);
    }
  }
  std::ranges::stable_sort(joining, std::ranges::greater(), &Hypothesis::evidence);
  bool connects = false;
  for (const Hypothesis& hypothesis : joining) {
    if (!accepted.components.join(hypothesis.frames)) continue;
    accepted = with(std::move(accepted), problem.candidates, hypothesis);
    connects = true;
  }
  return {std::move(accepted), connects};
}

/// Accepted alignments that the rest of the graph contradicts where it is certain.
std::set<std::size_t> contradicted_by_rest(std::span<const Candidate> candidates, const Accepted& accepted,
                                           const SolvedGraph& solved) {
  std::set<std::size_t> found;
  for (const auto& [alignment, c] : accepted.candidates) {
    const Innovation rest = innovation_without(candidates[c].factor, solved);
    if (rest.sigma_m < kCertainM && !(rest.distance < kInnovationGate)) found.insert(alignment);
  }
  return found;
}

/// A mode of an alignment, gated by the solved graph.
struct GatedMode {
  Innovation innovation;
  std::size_t candidate = 0;
  bool may_be_accepted = false;  ///< as a single candidate
};

/// The one of an alignment's compatible modes that a graph of certain position confirms: within the 98.6 %
/// quantile, and clearly more likely than the other modes.
std::optional<std::size_t> confirmed_mode(const std::vector<GatedMode>& modes) {
  const auto best =
      std::ranges::min_element(modes, {}, [](const GatedMode& mode) { return mode.innovation.cost; });
  if (!best->may_be_accepted || !(best->innovation.sigma_m <= kCertainM) ||
      best->innovation.distance > kSingleGate)
    return std::nullopt;
  const bool ahead = std::ranges::all_of(modes, [&](const GatedMode& mode) {
    return mode.candidate == best->candidate || mode.innovation.cost - best->innovation.cost > 2.0 * kMargin;
  });
  return ahead ? std::optional(best->candidate) : std::nullopt;
}

/// All candidates that are not accepted, gated by the solved graph.
struct Gating {
  std::map<FramePair, Indices> compatible;
  std::set<std::size_t> contradicting;
  std::map<std::size_t, std::size_t> confirmed;  ///< alignment to candidate
};

/// Input of one round.
struct RoundInput {
  const RejectionProblem& problem;
  const PriorEvidence& evidence;
  const TrialExclusions& exclusions;
  const SolvedGraph& solved;
  const Accepted& accepted;
  bool first_round = false;  ///< candidates that neighbours reject are tried from the second on
};

Gating gate(const RoundInput& input) {
  Gating gating;
  for (const auto& [frames, group] : input.evidence.gating.groups) {
    std::map<std::size_t, std::vector<GatedMode>> modes;  // by alignment
    for (const std::size_t c : group) {
      const Candidate& candidate = input.problem.candidates[c];
      if (input.accepted.candidates.contains(candidate.alignment) || input.exclusions.candidates.contains(c))
        continue;
      const Innovation one = innovation(candidate.factor, input.solved);
      if (!(one.distance < kInnovationGate)) {
        gating.contradicting.insert(c);
        continue;
      }
      const bool waits = input.first_round && input.evidence.rejected_by_neighbours.contains(c);
      if (!waits && !candidate.is_ambiguous_loop()) gating.compatible[frames].push_back(c);
      modes[candidate.alignment].push_back(
          {one, c, !waits && !input.evidence.contradicting_together.contains(c)});
    }
    if (!input.accepted.components.connects(frames)) continue;
    for (const auto& [alignment, of_alignment] : modes)
      if (const auto c = confirmed_mode(of_alignment)) gating.confirmed.emplace(alignment, *c);
  }
  return gating;
}

struct Round {
  Accepted accepted;
  std::set<std::size_t> contradicting;
  bool repeat = false;  ///< enough changed
};

Round next_round(const RoundInput& input) {
  const auto& [problem, evidence, exclusions, solved, accepted, first_round] = input;
  const std::set<std::size_t> refuted = contradicted_by_rest(problem.candidates, accepted, solved);
  Gating gating = gate(input);
  Round next{without(problem, accepted, refuted), std::move(gating.contradicting)};
  for (const std::size_t alignment : refuted) next.contradicting.insert(accepted.candidates.at(alignment));
  next.accepted.candidates.insert(gating.confirmed.begin(), gating.confirmed.end());
  const std::size_t singles = refuted.size() + gating.confirmed.size();
  const std::size_t before = next.accepted.candidates.size();
  // Within connected frames hypotheses wait until few single candidates change.
  const bool few = singles * kFewOf <= before;
  std::map<FramePair, ConsistentSets> sets;
  for (const auto& [frames, compatible] : gating.compatible) {
    if (!few && next.accepted.components.connects(frames)) continue;
    const ConsistentSets& of_pair = sets[frames] = consistent_sets(problem.candidates, compatible, solved);
    for (const Hypothesis& one : of_pair.rejected)
      next.contradicting.insert(one.members.begin(), one.members.end());
  }
  Joined joined = with_best_hypotheses(problem, std::move(next.accepted), sets, exclusions);
  next.accepted = std::move(joined.accepted);
  const std::size_t after = next.accepted.candidates.size();
  next.repeat = joined.connects || (singles + after - before) * kFewOf > after ||
                (first_round && !evidence.rejected_by_neighbours.empty());
  return next;
}

/// Accepted alignments whose residuals at the solution exceed the gate, although the solution yields to them.
/// The candidates of the last round have not been gated otherwise.
std::set<std::size_t> beyond_gate(std::span<const Candidate> candidates, const Accepted& accepted,
                                  const Estimate& estimate) {
  std::set<std::size_t> found;
  for (const auto& [alignment, c] : accepted.candidates) {
    const BetweenFactor& factor = candidates[c].factor;
    const Vector6d e = relative_residual(estimate, factor.a, factor.b, factor.T_a_b).e;
    if (!(CholeskyOf(inflated_covariance(factor)).squared_distance(e) < kInnovationGate))
      found.insert(alignment);
  }
  return found;
}

}  // namespace

std::vector<const BetweenFactor*> factors_of(std::span<const Candidate> candidates,
                                             const std::map<std::size_t, std::size_t>& accepted) {
  std::vector<const BetweenFactor*> factors;
  for (const auto& [alignment, c] : accepted) factors.push_back(&candidates[c].factor);
  return factors;
}

std::vector<int> ends_of(std::span<const Candidate> candidates) {
  std::vector<int> ends;
  for (const Candidate& candidate : candidates) {
    ends.push_back(static_cast<int>(candidate.factor.a));
    ends.push_back(static_cast<int>(candidate.factor.b));
  }
  return ends;
}

JoinedFrames join_frames(const RejectionProblem& problem, const PriorEvidence& evidence,
                         const TrialExclusions& exclusions, const Estimate& prior, GraphSolver& solver) {
  using Outcome = GraphSolver::Outcome;
  const std::span<const Candidate> candidates = problem.candidates;
  JoinedFrames result{.estimate = prior};
  const auto solve = [&](const Accepted& accepted, int steps) {
    result.accepted = accepted.candidates;
    return solver.solve(result.estimate, steps);
  };
  const Accepted none{{}, Components(problem.graph.frames.size())};
  Accepted accepted = with_best_hypotheses(problem, none, evidence.sets, exclusions).accepted;
  bool repeat = !accepted.candidates.empty();
  for (int round = 1; repeat; ++round) {
    const auto factors = factors_of(candidates, accepted.candidates);
    solver.set_alignments(factors);
    if (solve(accepted, kStepsPerRound) == Outcome::failed) return result;
    repeat = false;
    if (round <= kMaxRounds) {
      solver.invert(ends_of(candidates));
      const SolvedGraph solved{solver, result.estimate};
      Round next = next_round({problem, evidence, exclusions, solved, accepted, round == 1});
      accepted = std::move(next.accepted);
      result.contradicting = std::move(next.contradicting);
      repeat = next.repeat;
    }
    if (repeat) continue;
    if (const auto last = factors_of(candidates, accepted.candidates); last != factors)
      solver.set_alignments(last);
    if (solve(accepted, kMaxSteps) != Outcome::converged) return result;
  }
  const std::set<std::size_t> dropped = beyond_gate(candidates, accepted, result.estimate);
  for (const std::size_t alignment : dropped) result.contradicting.insert(accepted.candidates.at(alignment));
  if (!dropped.empty()) {
    accepted = without(problem, std::move(accepted), dropped);
    solver.set_alignments(factors_of(candidates, accepted.candidates));
    if (solve(accepted, kMaxSteps) != Outcome::converged) return result;
  }
  result.solved = true;
  return result;
}

}  // namespace fleetmap::graph
