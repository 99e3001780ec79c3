#pragma once

#include <vector>

#include "graph/simulated_fleet.hpp"
#include "problem/valid_items.hpp"
#include "rejection/prior_evidence.hpp"

namespace fleetmap::graph::testing {

/// A simulated fleet as outlier rejection gets it. `fleet` must outlive it.
struct ReducedFleet {
  explicit ReducedFleet(const SimulatedFleet& fleet, const FleetPlacementConfig& config = {});

  SortedItems items;
  ReducedGraph graph;
  std::vector<Candidate> candidates;
  std::vector<AgentId> computed_by;  ///< by alignment
  Estimate initial;

  RejectionProblem problem() const { return {graph, candidates}; }
  /// Indices of all candidates of the alignments between two agents.
  Indices between(const AgentId& a, const AgentId& b) const;
};

/// Its solution by GPS and odometry, ready for relative covariances of the candidates.
class PriorSolution {
 public:
  explicit PriorSolution(const ReducedFleet& fleet);
  SolvedGraph solved() const { return {solver_, estimate_}; }

 private:
  GraphSolver solver_;
  Estimate estimate_;
};

/// Gating, votes and consistent sets of all candidates.
PriorEvidence evidence_of(const ReducedFleet& fleet, const PriorSolution& prior);

}  // namespace fleetmap::graph::testing
