#pragma once

#include <map>
#include <optional>
#include <span>

#include "rejection/pairwise_consistency.hpp"

namespace fleetmap::graph {

/// Which alignments, in which mode, are right.
struct Selection {
  bool solvable = true;                           ///< GPS and odometry alone; if not, nothing is decided
  std::map<std::size_t, std::size_t> taken;       ///< alignment to candidate
  std::map<std::size_t, AlignmentStatus> judged;  ///< alignments that are not taken
  /// Of each agent: clusters of alignments that contradict, by the other agent of the pair.
  std::map<AgentId, std::map<AgentId, std::size_t>> mistakes;
  /// With which the estimate was solved, for covariances; none if the equations cannot be solved.
  std::optional<GraphSolver> solver;
};

/// Takes the hypotheses that connect frames first, best evidence first, solves, looks again at the rest with
/// what is known then, and so on. Where hypotheses contradict each other around a loop, goes without the one
/// that GPS and odometry contradict most. `estimate` is that without alignments, and becomes the one with
/// what was taken. `computed_by` runs by alignment.
Selection select_alignments(const ReducedGraph& graph, std::span<const Candidate> candidates,
                            std::span<const AgentId> computed_by, Estimate& estimate);

}  // namespace fleetmap::graph
