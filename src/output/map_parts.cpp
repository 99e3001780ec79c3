#include "fleetmap/output/map_parts.hpp"

#include <algorithm>
#include <set>

#include "fleetmap/graph/located_nodes.hpp"

namespace fleetmap::output {

MapParts map_parts(std::span<const graph::Node> nodes, const graph::Placement& placement) {
  const auto nowhere = graph::not_georeferenced(nodes, placement.components);
  const std::set<graph::FrameId> floating(nowhere.begin(), nowhere.end());
  MapParts parts;
  parts.main.georeferenced = true;
  for (const std::vector<graph::FrameId>& component : placement.components) {
    if (floating.contains(component.front())) {
      parts.apart.push_back({component, {}, false});
    } else {
      parts.main.frames.insert(parts.main.frames.end(), component.begin(), component.end());
    }
  }
  std::map<graph::FrameId, MapPart*> part_of;
  for (const graph::FrameId& frame : parts.main.frames) part_of[frame] = &parts.main;
  for (MapPart& part : parts.apart) {
    for (const graph::FrameId& frame : part.frames) part_of[frame] = &part;
  }
  for (const graph::Node& node : nodes) {
    const auto placed = placement.T_enu_node.find(node.id);
    const auto part = part_of.find(node.frame());
    if (placed != placement.T_enu_node.end() && part != part_of.end())
      part->second->T_map_node.emplace(placed->first, placed->second);
  }
  if (parts.main.frames.empty() && !parts.apart.empty()) {
    const auto size = [](const MapPart& part) { return part.T_map_node.size(); };
    const auto largest = std::ranges::max_element(parts.apart, {}, size);
    parts.main = std::move(*largest);
    parts.apart.erase(largest);
  }
  return parts;
}

std::string file_of(const MapPart& part) {
  const graph::FrameId& first = part.frames.front();
  std::string name = "map-" + first.agent.str();
  if (first.session > 0) name.append(".").append(std::to_string(first.session));
  return name.append(".ply");
}

}  // namespace fleetmap::output
