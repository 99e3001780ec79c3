#pragma once

#include <string>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::output {

/// The two texts of an exported graph.
struct GraphText {
  std::string graph;  ///< g2o
  std::string names;  ///< CSV: vertex,node,stamp_ns
};

/// The fleet graph in the text format of g2o: a VERTEX_SE3:QUAT for each placed node with its pose
/// T_enu_node, an EDGE_SE3:QUAT for the odometry between successive nodes of a frame and for each alignment
/// in use. Their information is that of translation and vector part of a quaternion, as g2o has it: for
/// rotation vectors it is four times too large. Readers refuse comments, so the names of the vertices are a
/// text of their own. A node's GPS shows in its pose alone, since the format has no edge for it.
GraphText to_g2o(const std::vector<graph::Node>& nodes, const graph::Placement& placement);

}  // namespace fleetmap::output
