#include "map_info.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <string>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/graph/contradictions.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/map_holes.hpp"

namespace fleetmap::apps {

void print_info(std::ostream& out, const StoredMap& map) {
  const auto submaps = std::ranges::count_if(
      map.items.nodes, [&](const graph::Node& node) { return map.store.has_submap(node.id); });
  out << "store of " << map.store.self().str() << '\n'
      << "nodes " << map.items.nodes.size() << ", submaps held " << submaps << ", alignments "
      << map.items.alignments.size() << " (" << map.placement.used.size() << " used)\n"
      << std::setprecision(10) << "origin " << map.recipe.origin.latitude / kDegree << ", "
      << map.recipe.origin.longitude / kDegree << " deg, " << map.recipe.origin.altitude << " m\n";
  if (const std::string holes = output::text_of_holes(map.store, map.items.nodes); !holes.empty())
    out << holes << '\n';
  for (const auto& component : map.placement.components) {
    out << "aligned together:";
    for (const graph::FrameId& frame : component) out << ' ' << graph::to_string(frame);
    out << '\n';
  }
  const auto contradicting =
      graph::contradict_the_fleet(map.placement, map.items.nodes, LocalFrame(map.recipe.origin));
  for (const auto& [agent, contradiction] : contradicting)
    out << agent.str() << " contradicts the fleet: " << to_string(contradiction) << "; --without "
        << agent.str() << " shows the map without it\n";
}

}  // namespace fleetmap::apps
