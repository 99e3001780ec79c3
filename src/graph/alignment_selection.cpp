#include "alignment_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace fleetmap::graph {
namespace {

constexpr int kMostRounds = 4;
constexpr int kMostTrials = 6;
/// A hypothesis must be ahead of the next one of its pair by this, as log odds: luck decides nothing.
constexpr double kMargin = 3.0;
/// Candidates of a pair that is tied already are judged by the odometry from the nearest tie while it knows
/// better than this.
constexpr double kNearM = 1.2;
constexpr double kNearGate = 16.0;
/// False alignments of a pair that shift by the same are one mistake.
constexpr double kSameMistakeM = 1.5;

struct Components {
  std::vector<std::size_t> parent;
  explicit Components(std::size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0u); }
  std::size_t root(std::size_t k) const {
    while (parent[k] != k) k = parent[k];
    return k;
  }
  bool join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    if (a == b) return false;
    parent[std::max(a, b)] = std::min(a, b);
    return true;
  }
};

/// How odometry's uncertainty grows along the frames: sums from the first pillar of each.
struct Growth {
  std::vector<double> metres, translation, rotation;

  explicit Growth(const ReducedGraph& graph)
      : metres(graph.pillars.size()), translation(metres), rotation(metres) {
    for (const Between& step : graph.odometry) {
      metres[step.b] = metres[step.a] + step.T_a_b.translation().norm();
      translation[step.b] = translation[step.a] + step.covariance.diagonal().head<3>().maxCoeff();
      rotation[step.b] = rotation[step.a] + step.covariance.diagonal().tail<3>().maxCoeff();
    }
  }
  /// Variances of the relative pose of two pillars of one frame, whose heading is a random walk: m^2, rad^2.
  std::pair<double, double> between(std::size_t p, std::size_t q) const {
    const double length = std::abs(metres[p] - metres[q]);
    const double turn = std::abs(rotation[p] - rotation[q]);
    return {std::abs(translation[p] - translation[q]) + turn * length * length / 3.0, turn};
  }
};

/// What is taken, and how it came.
struct State {
  std::set<std::size_t> banned;              ///< alignments
  std::map<std::size_t, std::size_t> taken;  ///< alignment to candidate
  std::vector<Hypothesis> tree;              ///< what connected frames first
  std::map<FramePair, Evaluation> last;      ///< of what is not taken, by all that is
  std::set<std::size_t> contradicting;       ///< candidates: what was taken rules them out
  double likelihood = 0.0;                   ///< log, of the whole
};

class Selector {
 public:
  Selector(const ReducedGraph& graph, std::span<const Candidate> candidates,
           std::span<const AgentId> computed_by)
      : graph_(graph),
        candidates_(candidates),
        computed_by_(computed_by),
        growth_(graph),
        unaided_(graph, {}) {
    for (std::size_t c = 0; c < candidates.size(); ++c) groups_[candidates[c].frames].push_back(c);
  }

  Selection run(Estimate& estimate) {
    if (!unaided_.solve(estimate, 6)) return {};
    for (const auto& [frames, group] : groups_)
      alone_.emplace(frames, evaluate(candidates_, group, unaided_, estimate));
    const Estimate start = estimate;
    rounds(estimate);
    doubt(start, estimate);
    return conclude(estimate);
  }

 private:
  void rounds(Estimate& estimate) {
    Components components(graph_.frames.size());
    bool more = take_from(alone_, components);
    for (int round = 1; more; ++round) {
      GraphSolver solver(graph_, ties());
      if (!solver.solve(estimate, 2)) return;
      look_again(solver, estimate);
      more = round < kMostRounds && take_from(state_.last, components);
      if (!more && !solver.solve(estimate, 12)) return;
    }
    state_.likelihood = -0.5 * unaided_.cost_without_ties(estimate);
    for (const auto& [frames, evaluation] : alone_) {
      for (const Hypothesis& hypothesis : evaluation.hypotheses)
        state_.likelihood += was_taken(hypothesis) ? hypothesis.support : 0.0;
    }
  }

  /// Evaluates what is not taken.
  void look_again(const GraphSolver& solver, const Estimate& estimate) {
    state_.last.clear();
    for (const auto& [frames, group] : groups_) {
      std::vector<std::size_t> open;
      for (const std::size_t c : group) {
        const std::size_t alignment = candidates_[c].alignment;
        if (!state_.taken.contains(alignment) && !state_.banned.contains(alignment) &&
            !state_.contradicting.contains(c))
          open.push_back(c);
      }
      if (open.empty()) continue;
      Evaluation& seen = state_.last[frames] = evaluate(candidates_, open, solver, estimate);
      state_.contradicting.insert(seen.contradicting.begin(), seen.contradicting.end());
    }
  }

  std::vector<Between> ties() const {
    std::vector<Between> ties;
    for (const auto& [alignment, candidate] : state_.taken) ties.push_back(candidates_[candidate].between);
    return ties;
  }

  bool is_banned(const Hypothesis& hypothesis) const {
    return std::ranges::any_of(
        hypothesis.members, [&](std::size_t c) { return state_.banned.contains(candidates_[c].alignment); });
  }

  /// The best hypothesis of a pair, if it is clearly the best.
  std::optional<Hypothesis> clear_best(const Evaluation& evaluation) const {
    const Hypothesis* best = nullptr;
    for (const Hypothesis& hypothesis : evaluation.hypotheses) {
      if (is_banned(hypothesis)) continue;
      if (best != nullptr) {
        if (best->evidence - hypothesis.evidence < kMargin) return std::nullopt;
        break;
      }
      best = &hypothesis;
    }
    if (best == nullptr || best->evidence <= 0.0) return std::nullopt;
    return *best;
  }

  void take(const Hypothesis& hypothesis) {
    for (const std::size_t c : hypothesis.members) state_.taken.emplace(candidates_[c].alignment, c);
  }

  /// True if anything was taken.
  bool take_from(const std::map<FramePair, Evaluation>& evaluations, Components& components) {
    const std::size_t before = state_.taken.size();
    std::vector<Hypothesis> connecting;
    for (const auto& [frames, evaluation] : evaluations) {
      const std::optional<Hypothesis> best = clear_best(evaluation);
      if (!best) continue;
      if (components.root(frames.first) == components.root(frames.second)) {
        take(*best);
      } else {
        connecting.push_back(*best);
      }
    }
    std::ranges::stable_sort(connecting, std::ranges::greater(), &Hypothesis::evidence);
    for (const Hypothesis& hypothesis : connecting) {
      // What would close a loop now is looked at again when the loop is known.
      if (!components.join(hypothesis.frames.first, hypothesis.frames.second)) continue;
      take(hypothesis);
      state_.tree.push_back(hypothesis);
    }
    for (const auto& [frames, evaluation] : evaluations) {
      while (take_near_ties(frames, evaluation.left_out)) {
      }
    }
    return state_.taken.size() > before;
  }

  /// Of a pair with very many candidates, those near what is taken follow from it and the odometry.
  /// True if there were any.
  bool take_near_ties(const FramePair& frames, const std::vector<std::size_t>& open) {
    std::map<std::size_t, const Between*> near;  // by the pillar in the first frame
    for (const std::size_t c : groups_.at(frames)) {
      const auto taken = state_.taken.find(candidates_[c].alignment);
      if (taken != state_.taken.end() && taken->second == c)
        near[end_in(frames.first, candidates_[c].between)] = &candidates_[c].between;
    }
    if (near.empty() || frames.first == frames.second) return false;
    const std::size_t before = state_.taken.size();
    for (const std::size_t c : open) {
      const Candidate& candidate = candidates_[c];
      if (state_.taken.contains(candidate.alignment) || state_.banned.contains(candidate.alignment)) continue;
      const auto after = near.lower_bound(end_in(frames.first, candidate.between));
      const bool agrees_with_any =
          (after != near.end() && agrees(candidate.between, *after->second)) ||
          (after != near.begin() && agrees(candidate.between, *std::prev(after)->second));
      if (!agrees_with_any) continue;
      state_.taken.emplace(candidate.alignment, c);
      near[end_in(frames.first, candidate.between)] = &candidate.between;
    }
    return state_.taken.size() > before;
  }

  std::size_t end_in(std::size_t frame, const Between& between) const {
    return graph_.pillars[between.a].frame == frame ? between.a : between.b;
  }

  /// Around the loop of two alignments and the odometry between their ends, if that is short.
  bool agrees(const Between& one, const Between& tie) const {
    // Ties of one pair of frames may name the frames in either order.
    const bool same = graph_.pillars[one.a].frame == graph_.pillars[tie.a].frame;
    const auto first = growth_.between(one.a, same ? tie.a : tie.b);
    const auto second = growth_.between(one.b, same ? tie.b : tie.a);
    const double metres = first.first + second.first, radians = first.second + second.second;
    if (metres > kNearM * kNearM) return false;
    const Pose T_tie = same ? tie.T_a_b : tie.T_a_b.inverse();
    const Pose T_a_a = odometry(one.a, same ? tie.a : tie.b);
    const Pose T_b_b = odometry(same ? tie.b : tie.a, one.b);
    const Vector6d e = se3_log(one.T_a_b.inverse() * T_a_a * T_tie * T_b_b);
    Matrix6d S = 4.0 * (one.covariance + tie.covariance);
    S.diagonal().head<3>().array() += metres + 0.01;
    S.diagonal().tail<3>().array() += radians + 1e-4;
    return e.dot(S.llt().solve(e)) < kNearGate;
  }

  Pose odometry(std::size_t p, std::size_t q) const {
    return graph_.nodes[graph_.pillars[p].node]->T_odom_base.inverse() *
           graph_.nodes[graph_.pillars[q].node]->T_odom_base;
  }

  bool was_taken(const Hypothesis& hypothesis) const {
    const auto taken = std::ranges::count_if(hypothesis.members, [&](std::size_t c) {
      const auto it = state_.taken.find(candidates_[c].alignment);
      return it != state_.taken.end() && it->second == c;
    });
    return 2 * static_cast<std::size_t>(taken) >= hypothesis.members.size();
  }

  /// Edges of the tree between two frames.
  std::vector<std::size_t> path(std::size_t from, std::size_t to) const {
    std::vector<std::optional<std::size_t>> arrived_by(graph_.frames.size());
    std::vector<std::size_t> queue{from};
    for (std::size_t at = 0; at < queue.size() && queue[at] != to; ++at) {
      for (std::size_t k = 0; k < state_.tree.size(); ++k) {
        const auto [a, b] = state_.tree[k].frames;
        const std::size_t next = a == queue[at] ? b : a;
        if ((a != queue[at] && b != queue[at]) || next == from || arrived_by[next]) continue;
        arrived_by[next] = k;
        queue.push_back(next);
      }
    }
    std::vector<std::size_t> edges;
    for (std::size_t at = to; at != from && arrived_by[at];) {
      edges.push_back(*arrived_by[at]);
      const auto [a, b] = state_.tree[*arrived_by[at]].frames;
      at = a == at ? b : a;
    }
    return edges;
  }

  /// What was taken first may be false: where it contradicts the hypotheses of other pairs, leaves out one
  /// after the other on the loop, and keeps what makes the whole likelier.
  void doubt(const Estimate& start, Estimate& estimate) {
    std::set<std::set<std::size_t>> tried;
    for (int trials = 0; trials < kMostTrials;) {
      const std::optional<std::set<std::size_t>> next = untried(tried);
      if (!next) return;
      tried.insert(*next);
      ++trials;
      State kept = std::exchange(state_, {});
      state_.banned = *next;
      Estimate trial = start;
      rounds(trial);
      if (state_.likelihood > kept.likelihood + kMargin) {
        estimate = std::move(trial);
      } else {
        state_ = std::move(kept);
      }
    }
  }

  /// What is banned now and the members of one more edge that lies on a loop with a rejected hypothesis.
  std::optional<std::set<std::size_t>> untried(const std::set<std::set<std::size_t>>& tried) const {
    for (const auto& [frames, evaluation] : alone_) {
      const std::optional<Hypothesis> best = clear_best(evaluation);
      if (!best || frames.first == frames.second || was_taken(*best)) continue;
      for (const std::size_t k : path(frames.first, frames.second)) {
        std::set<std::size_t> banned = state_.banned;
        for (const std::size_t c : state_.tree[k].members) banned.insert(candidates_[c].alignment);
        if (!tried.contains(banned)) return banned;
      }
    }
    return std::nullopt;
  }

  Selection conclude(const Estimate& estimate) const {
    Selection selection;
    selection.taken = state_.taken;
    std::map<std::size_t, std::pair<std::size_t, std::size_t>> against;  // modes: alone, at the end
    for (const auto& [frames, evaluation] : alone_)
      for (const std::size_t c : evaluation.contradicting) ++against[candidates_[c].alignment].first;
    for (const std::size_t c : state_.contradicting) ++against[candidates_[c].alignment].second;
    for (const auto& [frames, group] : groups_) {
      std::vector<std::pair<Eigen::Vector3d, AgentId>> clusters;
      for (const std::size_t c : group) {
        const Candidate& candidate = candidates_[c];
        if (state_.taken.contains(candidate.alignment)) continue;
        const auto [alone, end] = against[candidate.alignment];
        const bool banned = state_.banned.contains(candidate.alignment);
        selection.judged[candidate.alignment] = alone == candidate.modes           ? Judgement::against_gps
                                                : banned || end == candidate.modes ? Judgement::against_others
                                                                                   : Judgement::undecided;
        if (selection.judged[candidate.alignment] != Judgement::undecided && candidate.modes == 1)
          count_mistake(candidate, estimate, clusters, selection);
      }
    }
    return selection;
  }

  void count_mistake(const Candidate& candidate, const Estimate& estimate,
                     std::vector<std::pair<Eigen::Vector3d, AgentId>>& clusters, Selection& selection) const {
    const Between& between = candidate.between;
    const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
    const Eigen::Vector3d shift = -candidate.sign * (estimate.T_enu[between.b].linear() * r.e.head<3>());
    const AgentId& by = computed_by_[candidate.alignment];
    for (const auto& [other, agent] : clusters)
      if (agent == by && (other - shift).norm() < kSameMistakeM) return;
    clusters.emplace_back(shift, by);
    const AgentId& first = graph_.frames[candidate.frames.first].id.agent;
    const AgentId& second = graph_.frames[candidate.frames.second].id.agent;
    ++selection.mistakes[by][by == first ? second : first];
  }

  const ReducedGraph& graph_;
  std::span<const Candidate> candidates_;
  std::span<const AgentId> computed_by_;
  Growth growth_;
  GraphSolver unaided_;  ///< by GPS and odometry
  std::map<FramePair, std::vector<std::size_t>> groups_;
  std::map<FramePair, Evaluation> alone_;  ///< as unaided_ sees it
  State state_;
};

}  // namespace

Selection select_alignments(const ReducedGraph& graph, std::span<const Candidate> candidates,
                            std::span<const AgentId> computed_by, Estimate& estimate) {
  return Selector(graph, candidates, computed_by).run(estimate);
}

}  // namespace fleetmap::graph
