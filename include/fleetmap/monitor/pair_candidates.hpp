#pragma once

#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/graph/candidate_counts.hpp"

namespace fleetmap::monitor {

/// Candidates of one robot with another one, which has its own.
struct PairCandidates : graph::CandidateCounts {
  AgentId by, with;
  bool ended = false;  ///< as they were when the robot ended
  bool heard = true;   ///< `with` is
  bool operator==(const PairCandidates&) const = default;
};

/// All of it in words.
std::string sentence(const PairCandidates& candidates);

}  // namespace fleetmap::monitor
