#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

/// Places the contents of a store.
namespace fleetmap::output {

/// The origin of ENU: `configured`, else the position of the least node id held that has a G, so that agents
/// with the same nodes agree on it; 0, 0 where none has: the map then lies nowhere on Earth. Empty while
/// there is no node.
std::optional<GeoPoint> site_origin(const store::Store& store, const std::optional<GeoPoint>& configured);

/// Everything held, by name.
std::vector<graph::Node> nodes_of(const store::Store& store);
std::vector<graph::Alignment> alignments_of(const store::Store& store);

/// The items that a map is made of.
struct MapItems {
  std::vector<graph::Node> nodes;
  std::vector<graph::Alignment> alignments;
};
/// Everything held, by name, but for the nodes of `robots`, and the alignments that they computed or that end
/// at one of their nodes. Fails for a robot of which nothing is held, and if no node is left.
Result<MapItems> items_without(const store::Store& store, std::span<const AgentId> robots);

/// Stamp of the newest of these nodes; empty if none is held.
std::optional<Stamp> newest_stamp(const store::Store& store, const std::map<NodeId, Pose>& T_map_node);

/// Computes the pose of every node of the store.
graph::Placement place(const store::Store& store, const GeoPoint& origin,
                       const graph::PlacementConfig& config, std::span<const NodeId> covariance_of = {});

/// The content of map.ply: MapParts::main.
store::MergedMap main_map(store::Store& store, const graph::Placement& placement,
                          const store::MergeConfig& config);

}  // namespace fleetmap::output
