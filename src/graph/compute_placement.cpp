#include "fleetmap/graph/compute_placement.hpp"

#include <algorithm>

#include "fleet_placement.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "paper_placement.hpp"

namespace fleetmap::graph {

Placement compute_placement(std::span<const Node> nodes_as_made, std::span<const Alignment> alignments,
                            const LocalFrame& site, const PlacementConfig& config,
                            std::span<const NodeId> covariance_of) {
  if (config.method == PlacementMethod::graph &&
      std::ranges::all_of(nodes_as_made, [](const Node& node) { return node.G.has_value(); }))
    return place_by_fleet_graph(nodes_as_made, alignments, site, config.fleet, covariance_of);
  const std::vector<Node> nodes =
      with_global_poses(nodes_as_made, alignments, site, config.paper.gps_correlation_time);
  return config.method == PlacementMethod::graph
             ? place_by_fleet_graph(nodes, alignments, site, config.fleet, covariance_of)
             : place_by_min_rmse(nodes, alignments, site, config.paper);
}

}  // namespace fleetmap::graph
