#pragma once

#include <span>
#include <string>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::planning {

/// The best alignment known between the maps of two agents.
struct PairAlignment {
  AgentId a;
  AgentId b;
  double rmse = 0.0;  ///< m, E_ab of Eq. 2
};

/// Result of mapping_complete().
struct Completeness {
  bool complete = false;
  std::string why_not;  ///< empty when complete
};

/// The paper's end of a mission: every agent is connected to the whole fleet by alignments with E <= max_rmse
/// (directly or through others), and all hold the same nodes. A fleet of one is complete with its nodes.
/// Alignments of unknown agents, of an agent with itself or with an E that is not finite don't count.
Completeness mapping_complete(std::span<const AgentId> agents, std::span<const PairAlignment> alignments,
                              bool all_nodes_shared, double max_rmse = 0.4);

}  // namespace fleetmap::planning
