#pragma once

#include <optional>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"

namespace fleetmap::loop_closure {

using Track = std::vector<const graph::Node*>;  ///< the nodes of one odometry frame, in order

struct MapSessionCandidates {
  std::vector<LoopCandidate> candidates;  ///< the target is of the first track; nearest first
  std::optional<double> nearest_m;        ///< between nodes of the two tracks, by G
};

/// Pairs of nodes of two tracks whose odometry frames lie anywhere to each other.
MapSessionCandidates candidates_between(const Track& targets, const Track& sources,
                                        const CandidateConfig& config);

}  // namespace fleetmap::loop_closure
