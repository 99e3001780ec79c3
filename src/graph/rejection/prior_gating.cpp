#include "rejection/prior_gating.hpp"

#include <algorithm>

#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

/// What contradicts this many times as much as may be is not looked at again.
constexpr double kHopeless = 4.0;
constexpr int kMinContradictions = 2;

/// Takes the hopeless out of `group`. Returns those that contradict nothing.
std::vector<std::size_t> open_ones(std::span<const Candidate> candidates, const GraphSolver& solver,
                                   const Estimate& estimate, std::vector<std::size_t>& group,
                                   JudgedAlone& judged) {
  std::vector<std::size_t> open, hopeful;
  for (const std::size_t c : group) {
    const double distance = innovation(candidates[c].between, solver, estimate).distance;
    if (distance < kInnovationGate) {
      open.push_back(c);
    } else {
      judged.against_gps.insert(c);
    }
    if (distance < kHopeless * kInnovationGate) {
      hopeful.push_back(c);
    } else {
      judged.hopeless.insert(c);
    }
  }
  group = std::move(hopeful);
  return open;
}

/// Hypotheses that contradict as a whole, with what was not looked at of them.
void reject(std::span<const Candidate> candidates, const Evaluation& pair,
            const std::vector<std::size_t>& group, const GraphSolver& solver, const Estimate& estimate,
            JudgedAlone& judged) {
  const auto is_one_of_many = [](const Hypothesis& one) { return one.members.size() > 1; };
  for (const Hypothesis& one : pair.rejected)
    judged.against_gps.insert(one.members.begin(), one.members.end());
  if (std::ranges::none_of(pair.rejected, is_one_of_many)) return;
  std::vector<Hypothesis> hypotheses = pair.rejected;
  hypotheses.insert(hypotheses.end(), pair.hypotheses.begin(), pair.hypotheses.end());
  const auto members = agreeing(candidates, hypotheses, group, solver, estimate);
  for (std::size_t k = 0; k < pair.rejected.size(); ++k) {
    if (!is_one_of_many(pair.rejected[k])) continue;
    judged.against_gps.insert(members[k].begin(), members[k].end());
    judged.together.insert(members[k].begin(), members[k].end());
  }
}

}  // namespace

JudgedAlone judge_alone(std::span<const Candidate> candidates, const GraphSolver& solver,
                        const Estimate& estimate) {
  JudgedAlone judged;
  for (std::size_t c = 0; c < candidates.size(); ++c) judged.groups[candidates[c].frames].push_back(c);
  for (auto& [frames, group] : judged.groups) {
    std::vector<std::size_t> open = open_ones(candidates, solver, estimate, group, judged);
    const std::vector<Vote> votes = neighbours_votes(candidates, group, solver, estimate);
    std::set<std::size_t> outvoted;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (votes[k].disagree >= kMinContradictions && votes[k].disagree > votes[k].agree)
        outvoted.insert(group[k]);
    }
    const auto is_outvoted = [&](std::size_t c) { return outvoted.contains(c); };
    // Where all are, the votes decide nothing.
    if (!std::ranges::all_of(open, is_outvoted)) {
      std::erase_if(open, is_outvoted);
      judged.outvoted.merge(outvoted);
    }
    std::erase_if(open, [&](std::size_t c) { return candidates[c].is_ambiguous_loop(); });
    Evaluation& pair = judged.hypotheses[frames] = evaluate(candidates, open, solver, estimate);
    reject(candidates, pair, group, solver, estimate, judged);
  }
  return judged;
}

}  // namespace fleetmap::graph
