#include "fleetmap/graph/place.hpp"

#include <algorithm>

#include "fleetmap/graph/located_nodes.hpp"

namespace fleetmap::graph {

const char* to_string(PlacementMethod method) { return method == PlacementMethod::paper ? "paper" : "graph"; }

Status PlacementConfig::validate() const { return fleet.validate(); }

Placement place(std::span<const Node> nodes_as_made, std::span<const Alignment> alignments,
                const LocalFrame& site, const PlacementConfig& config,
                std::span<const NodeId> covariance_of) {
  if (config.method == PlacementMethod::graph &&
      std::ranges::all_of(nodes_as_made, [](const Node& node) { return node.G.has_value(); }))
    return place_by_fleet_graph(nodes_as_made, alignments, site, config.fleet, covariance_of);
  const std::vector<Node> nodes =
      with_global_poses(nodes_as_made, alignments, site, config.paper.gps_correlation_time);
  return config.method == PlacementMethod::graph
             ? place_by_fleet_graph(nodes, alignments, site, config.fleet, covariance_of)
             : place_by_least_rmse(nodes, alignments, site, config.paper);
}

}  // namespace fleetmap::graph
