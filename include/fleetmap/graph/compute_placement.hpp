#pragma once

#include <span>

#include "fleetmap/graph/placement.hpp"
#include "fleetmap/graph/placement_config.hpp"

namespace fleetmap::graph {

/// Computes the pose of every node by the configured method. A node without G gets one from
/// with_global_poses() first. Covariances are available from method `graph` only.
Placement compute_placement(std::span<const Node> nodes, std::span<const Alignment> alignments,
                            const LocalFrame& site, const PlacementConfig& config,
                            std::span<const NodeId> covariance_of = {});

}  // namespace fleetmap::graph
