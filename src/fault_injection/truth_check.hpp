#pragma once

#include <functional>
#include <optional>
#include <span>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::fault_injection {

/// Errors of the honest robots' nodes in a placement, m.
struct TruthErrors {
  double largest = 0.0;   ///< of a node against the simulated truth
  NodeId worst;           ///< that node
  double torn = 0.0;      ///< by which two nodes are displaced against each other, that alignments of honest
                          ///< robots connect, compared with the placement of the honest robots' items alone
  NodeId torn_a, torn_b;  ///< those nodes
};

struct TruthInput {
  std::span<const graph::Node> nodes;
  std::span<const graph::Alignment> alignments;
  std::optional<AgentId> compromised;
  const LocalFrame& site;
  /// T_enu_base of a node that a robot made; null for others.
  std::function<const Pose*(const NodeId&)> truth;
};

TruthErrors truth_errors(const graph::Placement& placement, const TruthInput& input);

}  // namespace fleetmap::fault_injection
