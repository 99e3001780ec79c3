#pragma once

#include <map>
#include <span>

#include "fleetmap/graph/placement.hpp"
#include "rejection/loop_check.hpp"

namespace fleetmap::graph {

/// Status of each alignment of `candidates` that is not accepted. It is rejected only if each of its modes
/// is: by the prior (`against_gps`), or at the end by its gate, by accepted alignments or by a loop
/// (`against_others`).
std::map<std::size_t, AlignmentStatus> rejected_statuses(std::span<const Candidate> candidates,
                                                         const PriorEvidence& evidence,
                                                         const LoopCheck& check);

}  // namespace fleetmap::graph
