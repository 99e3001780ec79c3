#include "fleetmap/graph/place.hpp"

namespace fleetmap::graph {

Placement place(std::span<const Node> nodes, std::span<const Alignment> alignments, const LocalFrame& site,
                const PlacementConfig& config) {
  return config.mode == PlacementMode::fleet ? place_by_fleet_graph(nodes, alignments, site, config.fleet)
                                             : place_by_least_rmse(nodes, alignments, site, config.paper);
}

}  // namespace fleetmap::graph
