#include "fleetmap/agent/map_parts.hpp"

#include <algorithm>
#include <set>

#include "fleetmap/graph/located_nodes.hpp"

namespace fleetmap::agent {

std::vector<MapPart> map_parts(std::span<const graph::Node> nodes, const graph::Placement& placement) {
  const auto nowhere = graph::not_georeferenced(nodes, placement.components);
  const std::set<graph::FrameId> floating(nowhere.begin(), nowhere.end());
  std::vector<MapPart> parts(1);
  parts.front().georeferenced = true;
  for (const std::vector<graph::FrameId>& component : placement.components) {
    if (floating.contains(component.front())) {
      parts.push_back({component, {}, false});
    } else {
      parts.front().frames.insert(parts.front().frames.end(), component.begin(), component.end());
    }
  }
  std::map<graph::FrameId, MapPart*> part_of;
  for (MapPart& part : parts) {
    for (const graph::FrameId& frame : part.frames) part_of[frame] = &part;
  }
  for (const graph::Node& node : nodes) {
    const auto placed = placement.T_enu_node.find(node.id);
    const auto part = part_of.find(node.frame());
    if (placed != placement.T_enu_node.end() && part != part_of.end())
      part->second->T_map_node.emplace(placed->first, placed->second);
  }
  if (parts.front().frames.empty()) {
    parts.erase(parts.begin());
    const auto size = [](const MapPart& part) { return part.T_map_node.size(); };
    if (!parts.empty()) std::iter_swap(parts.begin(), std::ranges::max_element(parts, {}, size));
  }
  return parts;
}

std::string file_of(const MapPart& part) {
  const graph::FrameId& first = part.frames.front();
  std::string name = "map-" + first.agent.str();
  if (first.session > 0) name.append(".").append(std::to_string(first.session));
  return name.append(".ply");
}

}  // namespace fleetmap::agent
