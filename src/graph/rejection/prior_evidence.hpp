#pragma once

#include <map>
#include <set>
#include <span>

#include "rejection/pairwise_consistency.hpp"
#include "rejection/prior_gating.hpp"

namespace fleetmap::graph {

/// Input of outlier rejection: the graph, and all candidates that may be accepted.
struct RejectionProblem {
  const ReducedGraph& graph;
  std::span<const Candidate> candidates;
};

/// Evidence of GPS and odometry alone about all candidates.
struct PriorEvidence {
  PriorGating gating;
  std::set<std::size_t> rejected_by_neighbours;
  std::map<FramePair, ConsistentSets> sets;  ///< of the compatible ones that neighbours do not reject
  std::set<std::size_t> contradicting;       ///< candidates: alone, or as members of a rejected hypothesis
  /// Members of rejected hypotheses of several candidates (a subset of the above), which are accepted as a
  /// whole or not at all.
  std::set<std::size_t> contradicting_together;
};

/// Adds the pairwise consistent sets of each frame pair to the results of the steps before.
PriorEvidence prior_evidence(std::span<const Candidate> candidates, PriorGating gating,
                             std::set<std::size_t> rejected_by_neighbours, const SolvedGraph& prior);

}  // namespace fleetmap::graph
