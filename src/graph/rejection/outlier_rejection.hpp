#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "fleetmap/graph/placement.hpp"
#include "rejection/candidate.hpp"

namespace fleetmap::graph {

/// The accepted alignments, each in one mode, and the graph solved with them.
struct Rejection {
  bool solvable = true;  ///< GPS and odometry alone can be solved; if not, nothing is accepted or rejected
  std::vector<Candidate> candidates;                ///< without those of quarantined agents
  std::map<std::size_t, std::size_t> accepted;      ///< alignment to candidate
  std::map<std::size_t, AlignmentStatus> rejected;  ///< alignments that are not accepted
  std::map<AgentId, std::size_t> outlier_sets;      ///< see rejection/quarantine.hpp
  std::set<AgentId> quarantined;
  std::optional<AgentId> contradicting;  ///< see rejection/agent_check.hpp
  Estimate estimate;
  /// Factored at `estimate`, for covariances; none if the equations cannot be solved.
  std::optional<GraphSolver> solver;
};

/// Outlier rejection. Each step is a file of this folder:
/// 1. gating by the prior (prior_gating),
/// 2. votes of neighbours (neighbour_votes),
/// 3. pairwise consistent sets of each pair of frames (pairwise_consistency, prior_evidence),
///    after which an agent that contradicts all others is left out (agent_check),
/// 4. joining of frames by the best sets (frame_joining),
/// 5. check of the loops that they form (loop_check),
/// 6. quarantine of agents with many outlier sets, after which 1 to 5 are repeated without them (quarantine).
/// Compared with PCM, graduated non-convexity and a Cauchy kernel in tests/bench/rejection_bench.cpp.
///
/// `initial`: poses to start from; `computed_by` runs by alignment. `graph` must outlive the result.
Rejection reject_outliers(const ReducedGraph& graph, std::vector<Candidate> candidates,
                          std::span<const AgentId> computed_by, const Estimate& initial);

}  // namespace fleetmap::graph
