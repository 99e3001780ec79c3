#include "graph/reduced_fleet.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "problem/initial_estimate.hpp"
#include "rejection/frame_joining.hpp"
#include "rejection/neighbour_votes.hpp"

namespace fleetmap::graph::testing {

ReducedFleet::ReducedFleet(const SimulatedFleet& fleet, const FleetPlacementConfig& config)
    : items(sorted_items(fleet.nodes, fleet.alignments, fleet.site)) {
  std::vector<NodeId> ends;
  for (const Alignment* a : items.alignments) {
    ends.insert(ends.end(), {a->i, a->j});
    computed_by.push_back(a->computed_by);
  }
  graph = reduce(items.nodes, ends, fleet.site, config);
  std::vector<std::size_t> all(items.alignments.size());
  std::iota(all.begin(), all.end(), 0u);
  candidates = candidates_of(items.alignments, all, graph, config);
  initial = initial_estimate(graph, fleet.site, config);
}

Indices ReducedFleet::between(const AgentId& a, const AgentId& b) const {
  Indices found;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Alignment& alignment = *items.alignments[candidates[c].alignment];
    if (std::set{alignment.i.agent, alignment.j.agent} == std::set{a, b}) found.push_back(c);
  }
  return found;
}

PriorSolution::PriorSolution(const ReducedFleet& fleet) : solver_(fleet.graph, {}), estimate_(fleet.initial) {
  solver_.solve(estimate_, kMaxSteps);
  solver_.invert(ends_of(fleet.candidates));
}

PriorEvidence evidence_of(const ReducedFleet& fleet, const PriorSolution& prior) {
  PriorGating gating = gate_by_prior(fleet.candidates, prior.solved());
  std::set<std::size_t> rejected = rejected_by_neighbours(fleet.candidates, gating, prior.solved());
  return prior_evidence(fleet.candidates, std::move(gating), std::move(rejected), prior.solved());
}

}  // namespace fleetmap::graph::testing
