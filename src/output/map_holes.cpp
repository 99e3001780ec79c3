#include "fleetmap/output/map_holes.hpp"

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::output {
namespace {

std::string share_of(std::size_t part, std::size_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole);
}

}  // namespace

std::map<AgentId, MapHoles> map_holes(const store::Store& store, std::span<const graph::Node> nodes) {
  std::map<AgentId, MapHoles> holes;
  for (const graph::Node& node : nodes) {
    MapHoles& robot = holes[node.id.agent];
    ++robot.nodes;
    if (!store.has_submap(node.id)) ++robot.without_submap;
  }
  std::erase_if(holes, [](const auto& entry) { return entry.second.without_submap == 0; });
  return holes;
}

std::string text_of_holes(const store::Store& store, std::span<const graph::Node> nodes) {
  std::string robots;
  std::size_t without_submap = 0;
  for (const auto& [robot, holes] : map_holes(store, nodes)) {
    append_to_list(robots, robot.str() + ": " + share_of(holes.without_submap, holes.nodes));
    without_submap += holes.without_submap;
  }
  if (without_submap == 0) return "";
  return share_of(without_submap, nodes.size()) + " nodes have no submap in this store (" + robots +
         "), so the map has holes there; use the store of a robot that holds them, or `fleetmap map merge`";
}

}  // namespace fleetmap::output
