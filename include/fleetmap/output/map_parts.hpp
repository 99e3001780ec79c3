#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::output {

/// Odometry frames whose nodes lie right to each other, and may be drawn into one map.
struct MapPart {
  std::vector<graph::FrameId> frames;
  std::map<NodeId, Pose> T_map_node;
  bool georeferenced = false;
};

/// The map of map.ply, and the parts that are written to files of their own.
struct MapParts {
  /// The content of map.ply: all georeferenced components, which ENU connects even if no alignment does. If
  /// there are none, the component with most nodes.
  MapPart main;
  /// Each other component, since its place in the main part would be a guess.
  std::vector<MapPart> apart;
};
MapParts map_parts(std::span<const graph::Node> nodes, const graph::Placement& placement);

/// "map-r2.ply", or "map-r2.4711.ply" of session 4711: of a part that is not the main one.
std::string file_of(const MapPart& part);

}  // namespace fleetmap::output
