#include "rejection/prior_evidence.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::graph {
namespace {

bool has_several(const Hypothesis& hypothesis) { return hypothesis.members.size() > 1; }

/// Members of the rejected hypotheses of several candidates, with those of `group` that belong to them.
std::set<std::size_t> rejected_together(std::span<const Candidate> candidates, const ConsistentSets& sets,
                                        std::span<const std::size_t> group, const SolvedGraph& prior) {
  std::set<std::size_t> rejected;
  if (std::ranges::none_of(sets.rejected, has_several)) return rejected;
  std::vector<Hypothesis> hypotheses = sets.rejected;
  hypotheses.insert(hypotheses.end(), sets.hypotheses.begin(), sets.hypotheses.end());
  const auto members = extended_members(candidates, hypotheses, group, prior);
  for (std::size_t k = 0; k < sets.rejected.size(); ++k)
    if (has_several(sets.rejected[k])) rejected.insert(members[k].begin(), members[k].end());
  return rejected;
}

}  // namespace

PriorEvidence prior_evidence(std::span<const Candidate> candidates, PriorGating gating,
                             std::set<std::size_t> rejected_by_neighbours, const SolvedGraph& prior) {
  PriorEvidence evidence;
  evidence.contradicting = gating.contradicting;
  evidence.gating = std::move(gating);
  evidence.rejected_by_neighbours = std::move(rejected_by_neighbours);
  for (const auto& [frames, group] : evidence.gating.groups) {
    Indices compatible = evidence.gating.compatible.at(frames);
    std::erase_if(compatible, [&](std::size_t c) {
      return evidence.rejected_by_neighbours.contains(c) || candidates[c].is_ambiguous_loop();
    });
    const ConsistentSets& sets = evidence.sets[frames] = consistent_sets(candidates, compatible, prior);
    for (const Hypothesis& one : sets.rejected)
      evidence.contradicting.insert(one.members.begin(), one.members.end());
    const std::set<std::size_t> together = rejected_together(candidates, sets, group, prior);
    evidence.contradicting.insert(together.begin(), together.end());
    evidence.contradicting_together.insert(together.begin(), together.end());
  }
  return evidence;
}

}  // namespace fleetmap::graph
