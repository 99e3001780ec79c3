#include "rejection/loop_check.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "rejection/joint_hypotheses.hpp"

namespace fleetmap::graph {
namespace {

constexpr int kMaxTrials = 6;
/// A hypothesis agrees with the accepted ones if this share of its members is accepted; a few fail alone.
constexpr double kMinShareAccepted = 0.8;
/// Bounds the log odds of a hypothesis against another one, because many members may fail for one common
/// reason.
constexpr double kMaxSupport = 24.0;

/// Members of each of `hypotheses` that are tested together, so that their cost is bounded.
std::size_t members_in_joint(std::size_t hypotheses) {
  return std::clamp<std::size_t>(3 * kMaxJointCandidates / std::max<std::size_t>(hypotheses, 1), 1,
                                 kMaxJointCandidates);
}

bool is_accepted(const RejectionProblem& problem, const JoinedFrames& joined, std::size_t candidate) {
  const auto it = joined.accepted.find(problem.candidates[candidate].alignment);
  return it != joined.accepted.end() && it->second == candidate;
}

double share_accepted(const RejectionProblem& problem, const JoinedFrames& joined,
                      const Hypothesis& hypothesis) {
  const auto accepted = std::ranges::count_if(hypothesis.members,
                                              [&](std::size_t c) { return is_accepted(problem, joined, c); });
  return static_cast<double>(accepted) / static_cast<double>(hypothesis.members.size());
}

/// The accepted candidates of each pair of different frames as a hypothesis.
std::vector<Hypothesis> accepted_hypotheses(const RejectionProblem& problem, const JoinedFrames& joined) {
  std::map<FramePair, Hypothesis> by_frames;
  for (const auto& [alignment, c] : joined.accepted)
    by_frames[problem.candidates[c].frames].members.push_back(c);
  std::vector<Hypothesis> accepted;
  for (auto& [frames, hypothesis] : by_frames) {
    if (frames.first == frames.second) continue;
    hypothesis.frames = frames;
    hypothesis.support = support_of(static_cast<double>(hypothesis.members.size()));
    accepted.push_back(std::move(hypothesis));
  }
  return accepted;
}

/// Accepted hypotheses that join several frames, each of which agrees with the prior and which together do
/// not. A frame of uncertain position between two others can displace these against their GPS. Empty if there
/// are none.
std::vector<Hypothesis> inconsistent_chain(const RejectionProblem& problem,
                                           std::span<const Hypothesis> joining, const SolvedGraph& prior) {
  if (joining.size() < 2) return {};
  const JointHypotheses joint(problem.candidates, joining, prior, members_in_joint(joining.size()));
  const Indices sound = joint.select([&](std::size_t k) { return joint.are_consistent(std::array{k}); });
  std::vector<Hypothesis> chain;
  if (joint.are_consistent(sound)) return chain;
  for (const std::size_t k : sound) chain.push_back(joining[k]);
  return chain;
}

/// The hypotheses around a loop that does not close, or of a chain that contradicts the prior, at least one
/// of which is false. Empty if there are none.
std::vector<Hypothesis> inconsistent_loop(const RejectionProblem& problem, const PriorEvidence& evidence,
                                          const LoopCheck& check, const SolvedGraph& prior) {
  const std::vector<Hypothesis> joining = accepted_hypotheses(problem, check.joined);
  for (const auto& [frames, sets] : evidence.sets) {
    const std::optional<Hypothesis> best = clear_best(sets, check.exclusions.candidates);
    if (!best || frames.first == frames.second ||
        share_accepted(problem, check.joined, *best) >= kMinShareAccepted)
      continue;
    std::vector<Hypothesis> loop = path_between(joining, frames, problem.graph.frames.size());
    loop.push_back(*best);
    if (loop.size() > 2) return loop;
  }
  return inconsistent_chain(problem, joining, prior);
}

/// Members of a hypothesis, with the candidates that were not linearised but belong to it.
Indices all_members(const RejectionProblem& problem, const PriorEvidence& evidence, const SolvedGraph& prior,
                    const Hypothesis& hypothesis) {
  const std::set<std::size_t> own(hypothesis.members.begin(), hypothesis.members.end());
  std::vector<Hypothesis> hypotheses{hypothesis};
  const ConsistentSets& sets = evidence.sets.at(hypothesis.frames);
  for (const auto* some : {&sets.hypotheses, &sets.rejected}) {
    std::ranges::copy_if(*some, std::back_inserter(hypotheses), [&](const Hypothesis& other) {
      return std::ranges::none_of(other.members, [&](std::size_t c) { return own.contains(c); });
    });
  }
  const Indices& group = evidence.gating.groups.at(hypothesis.frames);
  return extended_members(problem.candidates, hypotheses, group, prior).front();
}

/// With the outlier candidates of a loop: the false hypothesis, or all that may be it as undecided.
TrialExclusions with_outliers(TrialExclusions exclusions, const RejectionProblem& problem,
                              const PriorEvidence& evidence, const SolvedGraph& prior,
                              std::span<const Hypothesis> loop) {
  const std::vector<Hypothesis> outliers = outlier_candidates(problem.candidates, loop, prior);
  const bool decided = outliers.size() == 1;
  for (const Hypothesis& outlier : outliers) {
    const Indices members = all_members(problem, evidence, prior, outlier);
    exclusions.candidates.insert(members.begin(), members.end());
    if (decided) continue;
    exclusions.frames.insert(outlier.frames);
    exclusions.undecided.insert(members.begin(), members.end());
  }
  return exclusions;
}

}  // namespace

std::vector<Hypothesis> path_between(std::span<const Hypothesis> joining, const FramePair& frames,
                                     std::size_t frame_count) {
  const auto [from, to] = frames;
  std::vector<std::optional<std::size_t>> arrived_by(frame_count);
  Indices queue{from};
  for (std::size_t at = 0; at < queue.size() && queue[at] != to; ++at) {
    for (std::size_t k = 0; k < joining.size(); ++k) {
      const auto [a, b] = joining[k].frames;
      const std::size_t next = a == queue[at] ? b : a;
      if ((a != queue[at] && b != queue[at]) || next == from || arrived_by[next] ||
          joining[k].frames == frames)
        continue;
      arrived_by[next] = k;
      queue.push_back(next);
    }
  }
  std::vector<Hypothesis> path;
  for (std::size_t at = to; at != from && arrived_by[at];) {
    path.push_back(joining[*arrived_by[at]]);
    const auto [a, b] = path.back().frames;
    at = a == at ? b : a;
  }
  return path;
}

std::vector<Hypothesis> outlier_candidates(std::span<const Candidate> all, std::span<const Hypothesis> loop,
                                           const SolvedGraph& prior) {
  const JointHypotheses joint(all, loop, prior, members_in_joint(loop.size()));
  std::vector<double> likelihood;  // log, that all others are right
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Indices others = joint.select([k](std::size_t other) { return other != k; });
    double& l = likelihood.emplace_back(-0.5 * joint.distance(others));
    for (std::size_t other = 0; other < loop.size(); ++other)
      if (other != k) l += std::min(loop[other].support, kMaxSupport);
  }
  const double best = std::ranges::max(likelihood);
  std::vector<Hypothesis> outliers;
  for (std::size_t k = 0; k < loop.size(); ++k)
    if (likelihood[k] > best - kMargin) outliers.push_back(loop[k]);
  return outliers;
}

LoopCheck check_loops(const RejectionProblem& problem, const PriorEvidence& evidence,
                      const SolvedGraph& prior, JoinedFrames joined, GraphSolver& solver) {
  LoopCheck check{{}, std::move(joined)};
  for (int trials = 0; trials < kMaxTrials;) {
    const std::vector<Hypothesis> loop = inconsistent_loop(problem, evidence, check, prior);
    if (loop.empty()) break;
    TrialExclusions next = with_outliers(check.exclusions, problem, evidence, prior, loop);
    const bool excludes_accepted = std::ranges::any_of(
        next.candidates, [&](std::size_t c) { return is_accepted(problem, check.joined, c); });
    if (excludes_accepted) {
      ++trials;
      check.repeated = true;
      JoinedFrames trial = join_frames(problem, evidence, next, prior.estimate, solver);
      if (!trial.solved && check.joined.solved) break;
      check.joined = std::move(trial);
    } else if (next.candidates == check.exclusions.candidates) {
      break;
    }
    check.exclusions = std::move(next);
  }
  return check;
}

}  // namespace fleetmap::graph
