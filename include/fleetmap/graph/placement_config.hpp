#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/fleet_placement_config.hpp"
#include "fleetmap/graph/paper_placement_config.hpp"

namespace fleetmap::graph {

/// Method by which nodes are placed in ENU.
enum class PlacementMethod {
  paper,  ///< one rigid transform a pair of agents, that of least E_ij
  graph,  ///< the fleet's robust pose graph
};

const char* to_string(PlacementMethod method);

/// Method of the placement, and the settings of each method.
struct PlacementConfig {
  PlacementMethod method = PlacementMethod::graph;
  PaperPlacementConfig paper;
  FleetPlacementConfig fleet;
  Status validate() const;
};

}  // namespace fleetmap::graph
