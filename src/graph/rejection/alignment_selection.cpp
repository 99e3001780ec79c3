#include "rejection/alignment_selection.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "fleetmap/geometry/symmetric.hpp"
#include "rejection/innovation.hpp"
#include "rejection/prior_gating.hpp"

namespace fleetmap::graph {
namespace {

constexpr int kMaxRounds = 4;
/// Changes of fewer than one alignment in so many settle a round.
constexpr std::size_t kFewOf = 25;
/// To judge by, an estimate need not be exact; the last one must converge.
constexpr int kStepsARound = 2;
constexpr int kMaxTrials = 6;
/// Chi squared, three degrees of freedom, 1e-3: of a hypothesis between frames that others tie.
constexpr double kTiedShiftGate = 16.3;
/// A hypothesis fits the others if so many of its members do: all but some that fail by themselves.
constexpr double kClosed = 0.8;
constexpr double kSingleGate = 16.0;  // chi squared, six degrees of freedom, 1.4e-2
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

/// What loops that do not close rule out.
struct Doubts {
  std::set<std::size_t> left_out;      ///< candidates: hypotheses that fit no loop
  std::set<std::size_t> undecided;     ///< of these, where it could be others as well
  std::set<FramePair> not_to_connect;  ///< whose hypotheses are undecided
};

/// What is taken, and how it came.
struct State {
  Doubts doubts;
  std::map<std::size_t, std::size_t> taken;  ///< alignment to candidate
  std::set<std::size_t> contradicting;       ///< candidates: what is taken rules them out
  bool solved = false;
};

class Selector {
 public:
  Selector(const ReducedGraph& graph, std::span<const Candidate> candidates,
           std::span<const AgentId> computed_by)
      : graph_(graph), candidates_(candidates), computed_by_(computed_by), unaided_(graph, {}) {
    for (const Candidate& candidate : candidates) {
      ends_.push_back(static_cast<int>(candidate.between.a));
      ends_.push_back(static_cast<int>(candidate.between.b));
    }
  }

  Selection run(Estimate& estimate) {
    const Estimate rigid = estimate;
    if (unaided_.solve(estimate, kMaxSteps) != GraphSolver::Outcome::converged) {
      estimate = rigid;
      Selection nothing;
      nothing.solvable = false;
      return nothing;
    }
    unaided_.invert(ends_);
    alone_ = judge_alone(candidates_, unaided_, estimate);
    std::vector<GraphSolver::Ends> pairs_to_align;
    for (const auto& [frames, group] : alone_.groups)
      for (const std::size_t c : group)
        pairs_to_align.emplace_back(candidates_[c].between.a, candidates_[c].between.b);
    if (!pairs_to_align.empty()) tied_.emplace(graph_, pairs_to_align);
    const Estimate start = estimate;
    rounds(estimate);
    const bool tried = doubt(start, estimate);
    if (!state_.solved) {
      // What ties frames cannot be solved with: they lie where GPS says, and nothing is decided.
      state_ = {};
      estimate = start;
    }
    Selection selection = conclude(estimate);
    if (tried && !state_.taken.empty()) {
      tied_->set_alignments(ties());
      tied_->factor_at(estimate);
    }
    GraphSolver& solver = state_.taken.empty() ? unaided_ : *tied_;
    if (solver.solved()) selection.solver = std::move(solver);
    return selection;
  }

 private:
  void rounds(Estimate& estimate) {
    Components components(graph_.frames.size());
    take_from(alone_.hypotheses, components);
    bool more = !state_.taken.empty();
    for (int round = 1; more; ++round) {
      const std::vector<const BetweenFactor*> judged_by = ties();
      tied_->set_alignments(judged_by);
      if (tied_->solve(estimate, kStepsARound) == GraphSolver::Outcome::failed) return;
      more = round <= kMaxRounds && look_again(estimate, components, round == 1);
      if (more) continue;
      if (ties() != judged_by) tied_->set_alignments(ties());
      if (tied_->solve(estimate, kMaxSteps) != GraphSolver::Outcome::converged) return;
    }
    if (drop_contradicted(estimate)) {
      tied_->set_alignments(ties());
      if (tied_->solve(estimate, kMaxSteps) != GraphSolver::Outcome::converged) return;
    }
    state_.solved = true;
  }

  /// Judges everything by the tied graph. True if what changed is worth another look.
  bool look_again(const Estimate& estimate, Components& components, bool first) {
    tied_->invert(ends_);
    const std::set<std::size_t> doubtful = contradicted_by_rest(estimate);
    state_.contradicting.clear();
    std::map<std::size_t, std::size_t> expected;  // alignment to candidate
    std::map<FramePair, std::vector<std::size_t>> open;
    for (const auto& [frames, group] : alone_.groups) {
      const bool tied = components.root(frames.first) == components.root(frames.second);
      std::map<std::size_t, std::vector<Seen>> modes;  // by alignment
      for (const std::size_t c : group) {
        const std::size_t alignment = candidates_[c].alignment;
        if (state_.taken.contains(alignment) || state_.doubts.left_out.contains(c)) continue;
        const Innovation seen = innovation(candidates_[c].between, *tied_, estimate);
        if (seen.distance < kInnovationGate) {
          const bool waits = first && alone_.outvoted.contains(c);
          if (!waits && !candidates_[c].is_ambiguous_loop()) open[frames].push_back(c);
          // What GPS contradicts, with all that agrees with it, comes back with all of it or not at all.
          modes[alignment].push_back({seen, c, !waits && !alone_.together.contains(c)});
        } else {
          state_.contradicting.insert(c);
        }
      }
      if (!tied) continue;
      for (const auto& [alignment, seen] : modes) {
        if (const auto c = the_expected_one(seen)) expected.emplace(alignment, *c);
      }
    }
    drop(doubtful, components);
    state_.taken.insert(expected.begin(), expected.end());
    // A few more or less among very many change nothing that others are judged by.
    const bool settled = (doubtful.size() + expected.size()) * kFewOf <= state_.taken.size();
    std::map<FramePair, Evaluation> evaluations;
    for (const auto& [frames, candidates] : open) {
      // Within what is tied, the rest waits until the single ones are decided.
      const bool tied = components.root(frames.first) == components.root(frames.second);
      if (settled || !tied) evaluations[frames] = evaluate(candidates_, candidates, *tied_, estimate);
    }
    for (const auto& [frames, evaluation] : evaluations)
      for (const Hypothesis& hypothesis : evaluation.rejected)
        state_.contradicting.insert(hypothesis.members.begin(), hypothesis.members.end());
    const std::size_t before = state_.taken.size();
    const bool connected = take_from(evaluations, components);
    const std::size_t changed = doubtful.size() + expected.size() + state_.taken.size() - before;
    return connected || changed * kFewOf > state_.taken.size() || (first && !alone_.outvoted.empty());
  }

  /// Takes them back, and with them the connections that nothing else makes.
  void drop(const std::set<std::size_t>& alignments, Components& components) {
    for (const std::size_t alignment : alignments) {
      state_.contradicting.insert(state_.taken.at(alignment));
      state_.taken.erase(alignment);
    }
    if (alignments.empty()) return;
    components = Components(graph_.frames.size());
    for (const auto& [alignment, c] : state_.taken)
      components.join(candidates_[c].frames.first, candidates_[c].frames.second);
  }

  /// What was taken last, nothing has judged since: takes back what the solution contradicts, though it
  /// pulled there. True if there was any.
  bool drop_contradicted(const Estimate& estimate) {
    return std::erase_if(state_.taken, [&](const auto& one) {
             const BetweenFactor& tie = candidates_[one.second].between;
             const Vector6d e = relative_residual(estimate, tie.a, tie.b, tie.T_a_b).e;
             const bool contradicted =
                 !(CholeskyOf(inflated_covariance(tie)).squared_distance(e) < kInnovationGate);
             if (contradicted) state_.contradicting.insert(one.second);
             return contradicted;
           }) > 0;
  }

  bool is_taken(std::size_t candidate) const {
    const auto it = state_.taken.find(candidates_[candidate].alignment);
    return it != state_.taken.end() && it->second == candidate;
  }

  /// Alignments that are taken, but that the others contradict.
  std::set<std::size_t> contradicted_by_rest(const Estimate& estimate) const {
    std::set<std::size_t> found;
    for (const auto& [alignment, c] : state_.taken) {
      const Innovation rest = innovation_without(candidates_[c].between, *tied_, estimate);
      if (rest.sigma_m < kCertainM && !(rest.distance < kInnovationGate)) found.insert(alignment);
    }
    return found;
  }

  struct Seen {
    Innovation by_graph;
    std::size_t candidate = 0;
    bool may_be_taken = false;
  };
  /// Of the modes of one alignment that nothing contradicts, the one that is where the graph knows it must
  /// be.
  static std::optional<std::size_t> the_expected_one(const std::vector<Seen>& modes) {
    const auto best =
        std::ranges::min_element(modes, {}, [](const Seen& mode) { return mode.by_graph.cost; });
    if (!best->may_be_taken || !(best->by_graph.sigma_m <= kCertainM) ||
        best->by_graph.distance > kSingleGate)
      return std::nullopt;
    const bool ahead = std::ranges::all_of(modes, [&](const Seen& mode) {
      return mode.candidate == best->candidate || mode.by_graph.cost - best->by_graph.cost > 2.0 * kMargin;
    });
    return ahead ? std::optional(best->candidate) : std::nullopt;
  }

  std::vector<const BetweenFactor*> ties() const {
    std::vector<const BetweenFactor*> ties;
    for (const auto& [alignment, candidate] : state_.taken) ties.push_back(&candidates_[candidate].between);
    return ties;
  }

  bool is_left_out(const Hypothesis& hypothesis) const {
    return std::ranges::any_of(hypothesis.members,
                               [&](std::size_t c) { return state_.doubts.left_out.contains(c); });
  }

  /// The best hypothesis of a pair, if it is clearly the best.
  std::optional<Hypothesis> clear_best(const Evaluation& evaluation) const {
    const Hypothesis* best = nullptr;
    for (const Hypothesis& hypothesis : evaluation.hypotheses) {
      if (is_left_out(hypothesis)) continue;
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

  /// True if it connects frames.
  bool take_from(const std::map<FramePair, Evaluation>& evaluations, Components& components) {
    bool connects = false;
    std::vector<Hypothesis> connecting;
    for (const auto& [frames, evaluation] : evaluations) {
      const std::optional<Hypothesis> best = clear_best(evaluation);
      if (!best) continue;
      if (components.root(frames.first) == components.root(frames.second)) {
        if (best->shift < kTiedShiftGate) take(*best);
      } else if (!state_.doubts.not_to_connect.contains(frames)) {
        connecting.push_back(*best);
      }
    }
    std::ranges::stable_sort(connecting, std::ranges::greater(), &Hypothesis::evidence);
    for (const Hypothesis& hypothesis : connecting) {
      // What would close a loop now is looked at again when the loop is known.
      if (!components.join(hypothesis.frames.first, hypothesis.frames.second)) continue;
      take(hypothesis);
      connects = true;
    }
    return connects;
  }

  double share_taken(const Hypothesis& hypothesis) const {
    const auto taken = std::ranges::count_if(hypothesis.members, [&](std::size_t c) { return is_taken(c); });
    return static_cast<double>(taken) / static_cast<double>(hypothesis.members.size());
  }

  /// What ties each pair of frames, as a hypothesis.
  std::vector<Hypothesis> ties_as_hypotheses() const {
    std::map<FramePair, Hypothesis> by_frames;
    for (const auto& [alignment, c] : state_.taken) by_frames[candidates_[c].frames].members.push_back(c);
    std::vector<Hypothesis> ties;
    for (auto& [frames, tie] : by_frames) {
      if (frames.first == frames.second) continue;
      tie.frames = frames;
      tie.support = support_of(static_cast<double>(tie.members.size()));
      ties.push_back(std::move(tie));
    }
    return ties;
  }

  /// The shortest way of ties from one of the frames to the other that is not what ties the two themselves.
  static std::vector<Hypothesis> way_round(const std::vector<Hypothesis>& ties, const FramePair& frames,
                                           std::size_t frame_count) {
    const auto [from, to] = frames;
    std::vector<std::optional<std::size_t>> arrived_by(frame_count);
    std::vector<std::size_t> queue{from};
    for (std::size_t at = 0; at < queue.size() && queue[at] != to; ++at) {
      for (std::size_t k = 0; k < ties.size(); ++k) {
        const auto [a, b] = ties[k].frames;
        const std::size_t next = a == queue[at] ? b : a;
        if ((a != queue[at] && b != queue[at]) || next == from || arrived_by[next] ||
            ties[k].frames == frames)
          continue;
        arrived_by[next] = k;
        queue.push_back(next);
      }
    }
    std::vector<Hypothesis> way;
    for (std::size_t at = to; at != from && arrived_by[at];) {
      way.push_back(ties[*arrived_by[at]]);
      const auto [a, b] = way.back().frames;
      at = a == at ? b : a;
    }
    return way;
  }

  /// Where hypotheses contradict each other around a loop one of them is false: leaves out the one without
  /// which GPS and odometry fit the others best, and all that it could be if luck would decide. True if
  /// anything was solved again.
  bool doubt(const Estimate& start, Estimate& estimate) {
    int trials = 0;
    while (trials < kMaxTrials) {
      const std::vector<Hypothesis> loop = open_loop();
      if (loop.empty()) break;
      Doubts doubts = state_.doubts;
      bool changes = false;
      const std::vector<Hypothesis> suspects = suspects_of(candidates_, loop, unaided_, start);
      const bool decided = suspects.size() == 1;
      for (const Hypothesis& suspect : suspects) {
        if (!decided) doubts.not_to_connect.insert(suspect.frames);
        for (const std::size_t c : whole(suspect, start)) {
          changes = changes || is_taken(c);
          doubts.left_out.insert(c);
          if (!decided) doubts.undecided.insert(c);
        }
      }
      if (!changes) {
        if (doubts.left_out == state_.doubts.left_out) break;
        state_.doubts = std::move(doubts);
        continue;
      }
      ++trials;
      const State before = std::exchange(state_, {});
      state_.doubts = std::move(doubts);
      Estimate trial = start;
      rounds(trial);
      if (!state_.solved && before.solved) {
        state_ = before;
        break;
      }
      estimate = std::move(trial);
    }
    return trials > 0;
  }

  /// Its members, with what was not looked at.
  std::vector<std::size_t> whole(const Hypothesis& hypothesis, const Estimate& start) const {
    const std::set<std::size_t> own(hypothesis.members.begin(), hypothesis.members.end());
    std::vector<Hypothesis> hypotheses{hypothesis};
    const Evaluation& pair = alone_.hypotheses.at(hypothesis.frames);
    for (const auto* some : {&pair.hypotheses, &pair.rejected}) {
      std::ranges::copy_if(*some, std::back_inserter(hypotheses), [&](const Hypothesis& other) {
        return std::ranges::none_of(other.members, [&](std::size_t c) { return own.contains(c); });
      });
    }
    return agreeing(candidates_, hypotheses, alone_.groups.at(hypothesis.frames), unaided_, start).front();
  }

  /// The hypotheses around a loop that does not close, at least one of which is false. Empty if all close.
  std::vector<Hypothesis> open_loop() const {
    const std::vector<Hypothesis> ties = ties_as_hypotheses();
    for (const auto& [frames, evaluation] : alone_.hypotheses) {
      const std::optional<Hypothesis> best = clear_best(evaluation);
      if (!best || frames.first == frames.second || share_taken(*best) >= kClosed) continue;
      std::vector<Hypothesis> loop = way_round(ties, frames, graph_.frames.size());
      loop.push_back(*best);
      if (loop.size() > 2) return loop;
    }
    return {};
  }

  Selection conclude(const Estimate& estimate) const {
    Selection selection;
    selection.taken = state_.taken;
    std::set<std::size_t> ruled_out = state_.contradicting;
    ruled_out.insert(alone_.hopeless.begin(), alone_.hopeless.end());
    ruled_out.insert(state_.doubts.left_out.begin(), state_.doubts.left_out.end());
    std::map<std::size_t, std::pair<std::size_t, std::size_t>> against;  // modes: alone, at the end
    for (const std::size_t c : alone_.against_gps) ++against[candidates_[c].alignment].first;
    for (const std::size_t c : ruled_out) ++against[candidates_[c].alignment].second;
    std::set<std::size_t> undecided;  // alignments
    for (const std::size_t c : state_.doubts.undecided) undecided.insert(candidates_[c].alignment);
    std::map<std::size_t, std::size_t> modes;
    for (const Candidate& candidate : candidates_) ++modes[candidate.alignment];
    std::map<FramePair, std::vector<std::pair<Eigen::Vector3d, AgentId>>> clusters;
    for (const Candidate& candidate : candidates_) {
      if (state_.taken.contains(candidate.alignment) || selection.judged.contains(candidate.alignment))
        continue;
      const auto [alone, end] = against[candidate.alignment];
      const std::size_t all = modes[candidate.alignment];
      const AlignmentStatus status = alone == all                              ? AlignmentStatus::against_gps
                                     : undecided.contains(candidate.alignment) ? AlignmentStatus::undecided
                                     : end == all ? AlignmentStatus::against_others
                                                  : AlignmentStatus::undecided;
      selection.judged[candidate.alignment] = status;
      // Of one that is ambiguous by its first mode: that none of them is right is one mistake.
      if (status != AlignmentStatus::undecided)
        count_mistake(candidate, estimate, clusters[candidate.frames], selection);
    }
    return selection;
  }

  void count_mistake(const Candidate& candidate, const Estimate& estimate,
                     std::vector<std::pair<Eigen::Vector3d, AgentId>>& clusters, Selection& selection) const {
    const BetweenFactor& between = candidate.between;
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
  GraphSolver unaided_;              ///< by GPS and odometry
  std::optional<GraphSolver> tied_;  ///< by what is taken as well
  std::vector<int> ends_;            ///< poses of the candidates
  JudgedAlone alone_;                ///< as unaided_ sees it
  State state_;
};

}  // namespace

Selection select_alignments(const ReducedGraph& graph, std::span<const Candidate> candidates,
                            std::span<const AgentId> computed_by, Estimate& estimate) {
  return Selector(graph, candidates, computed_by).run(estimate);
}

}  // namespace fleetmap::graph
