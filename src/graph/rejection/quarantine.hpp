#pragma once

#include <map>
#include <set>
#include <span>

#include "fleetmap/graph/placement.hpp"
#include "rejection/candidate.hpp"

namespace fleetmap::graph {

/// Outlier sets of each agent that computed any. Rejected alignments that it computed of one pair of frames,
/// and that deviate from the estimate by the same translation within 1.5 m, are one set: they have one cause,
/// such as a row of panels. Sets with one other agent count twice at most, because that agent's clouds may be
/// the cause. An ambiguous alignment counts by its first mode. `statuses` are those of the alignments that
/// are not accepted, `computed_by` runs by alignment.
std::map<AgentId, std::size_t> outlier_sets(const ReducedGraph& graph, std::span<const Candidate> candidates,
                                            const std::map<std::size_t, AlignmentStatus>& statuses,
                                            std::span<const AgentId> computed_by, const Estimate& estimate);

/// Agents with four outlier sets or more, and at least twice as many as accepted alignments. None of the
/// alignments that they computed is used. `accepted` are the numbers of accepted alignments by agent.
///
/// No publication that we know excludes agents by their record.
std::set<AgentId> to_quarantine(const std::map<AgentId, std::size_t>& outlier_sets,
                                const std::map<AgentId, std::size_t>& accepted);

}  // namespace fleetmap::graph
