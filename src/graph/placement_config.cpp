#include "fleetmap/graph/placement_config.hpp"

namespace fleetmap::graph {

const char* to_string(PlacementMethod method) { return method == PlacementMethod::paper ? "paper" : "graph"; }

Status PlacementConfig::validate() const { return fleet.validate(); }

}  // namespace fleetmap::graph
