#pragma once

#include "fleetmap/graph/candidate_counts.hpp"

namespace fleetmap::loop_closure {

/// A robot's candidates with one other robot.
struct PeerCandidates : graph::CandidateCounts {
  bool heard = false;  ///< the other robot is; else no cloud is requested
};

}  // namespace fleetmap::loop_closure
