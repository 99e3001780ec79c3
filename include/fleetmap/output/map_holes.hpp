#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Nodes of one robot, and those of them whose submap the store does not hold.
struct MapHoles {
  std::size_t nodes = 0, without_submap = 0;
};
/// The robots whose submaps the store lacks: its map has holes around these nodes, because their bodies were
/// not received.
std::map<AgentId, MapHoles> map_holes(const store::Store& store, std::span<const graph::Node> nodes);
/// "3 of 12 nodes have no submap in this store (r2: 3 of 6), so the map has holes there; ..."; empty where it
/// lacks none.
std::string text_of_holes(const store::Store& store, std::span<const graph::Node> nodes);

}  // namespace fleetmap::output
