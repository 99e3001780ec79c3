#pragma once

#include <span>

#include "fleetmap/graph/fleet_placement.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

enum class PlacementMethod {
  paper,  ///< one rigid transform a pair of agents, that of least E_ij
  graph,  ///< the fleet's robust pose graph
};

const char* to_string(PlacementMethod method);

struct PlacementConfig {
  PlacementMethod method = PlacementMethod::graph;
  PaperPlacementConfig paper;
  FleetPlacementConfig fleet;
  Status validate() const;
};

/// Where every node lies, by the method that is set; nodes without a G as with_global_poses() says.
/// Covariances come with method `graph` alone.
Placement place(std::span<const Node> nodes, std::span<const Alignment> alignments, const LocalFrame& site,
                const PlacementConfig& config, std::span<const NodeId> covariance_of = {});

}  // namespace fleetmap::graph
