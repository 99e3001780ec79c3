#pragma once

#include <span>

#include "fleetmap/graph/fleet_placement_config.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

/// The fleet's robust pose graph (method `graph`): odometry between the nodes of a frame, G of every node
/// with an error that drifts slowly (a Gauss-Markov process for each robot), and those alignments, each in at
/// most one of its modes, that agree with GPS, odometry and each other. Alignments that do not are rejected,
/// and so are all of an agent that mostly computes such (quarantine).
///
/// A function of the set alone, bit for bit: items are sorted first, and nothing is kept from call to call.
/// Items with non-finite or impossible numbers do not count. The covariance of the nodes in `covariance_of`
/// is computed as well.
Placement place_by_fleet_graph(std::span<const Node> nodes, std::span<const Alignment> alignments,
                               const LocalFrame& site, const FleetPlacementConfig& config = {},
                               std::span<const NodeId> covariance_of = {});

}  // namespace fleetmap::graph
