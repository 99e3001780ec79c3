#pragma once

#include <map>
#include <set>
#include <span>

#include "rejection/candidate.hpp"

namespace fleetmap::graph {

/// Result of gating all candidates by the prior, which is the graph of GPS and odometry without alignments.
struct PriorGating {
  std::map<FramePair, Indices> groups;      ///< candidates that are not gated out, by frame pair
  std::map<FramePair, Indices> compatible;  ///< those of them that the prior does not contradict
  std::set<std::size_t> contradicting;      ///< candidates beyond kInnovationGate
  std::set<std::size_t> gated_out;          ///< those of them beyond four times the gate: never accepted
};

/// Gates each candidate alone by the squared Mahalanobis distance of its innovation: individual compatibility
/// (Neira and Tardos, IEEE T-RA 17(6), 2001). `prior` must be ready
/// for relative_covariance() between the candidates' ends.
PriorGating gate_by_prior(std::span<const Candidate> candidates, const SolvedGraph& prior);

}  // namespace fleetmap::graph
