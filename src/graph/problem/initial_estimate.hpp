#pragma once

#include "fleetmap/geometry/geodesy.hpp"
#include "problem/estimate.hpp"

namespace fleetmap::graph {

/// Starting values: each frame as a rigid body at the least-squares fit to its fixes.
Estimate initial_estimate(const ReducedGraph& graph, const LocalFrame& site,
                          const FleetPlacementConfig& config);

}  // namespace fleetmap::graph
