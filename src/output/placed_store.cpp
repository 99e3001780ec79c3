#include "fleetmap/output/placed_store.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/map_parts.hpp"

namespace fleetmap::output {

std::optional<GeoPoint> site_origin(const store::Store& store, const std::optional<GeoPoint>& configured) {
  if (configured) return configured;
  if (store.nodes().empty()) return std::nullopt;
  for (const auto& [id, node] : store.nodes()) {
    if (node.G) return node.G->position;
  }
  return GeoPoint{};
}

std::vector<graph::Node> nodes_of(const store::Store& store) {
  std::vector<graph::Node> nodes;
  nodes.reserve(store.nodes().size());
  for (const auto& [id, node] : store.nodes()) nodes.push_back(node);
  return nodes;
}

std::vector<graph::Alignment> alignments_of(const store::Store& store) {
  std::vector<graph::Alignment> alignments;
  alignments.reserve(store.alignments().size());
  for (const auto& [id, alignment] : store.alignments()) alignments.push_back(alignment);
  return alignments;
}

Result<MapItems> items_without(const store::Store& store, std::span<const AgentId> robots) {
  std::set<AgentId> makers;
  for (const auto& [id, node] : store.nodes()) makers.insert(id.agent);
  for (const auto& [id, alignment] : store.alignments()) makers.insert(id.computed_by);
  for (const AgentId& robot : robots) {
    if (makers.contains(robot)) continue;
    std::string known;
    for (const AgentId& maker : makers) append_to_list(known, maker.str());
    return failure(store.path().string() + ": holds nothing of '" + robot.str() + "', but of " + known);
  }
  const auto left_out = [&](const AgentId& robot) {
    return std::ranges::find(robots, robot) != robots.end();
  };
  MapItems items{nodes_of(store), alignments_of(store)};
  std::erase_if(items.nodes, [&](const graph::Node& node) { return left_out(node.id.agent); });
  std::erase_if(items.alignments, [&](const graph::Alignment& one) {
    return left_out(one.computed_by) || left_out(one.i.agent) || left_out(one.j.agent);
  });
  if (items.nodes.empty() && !robots.empty())
    return failure(store.path().string() + ": without these robots no node is left, so there is no map");
  return items;
}

std::optional<Stamp> newest_stamp(const store::Store& store, const std::map<NodeId, Pose>& T_map_node) {
  std::optional<Stamp> newest;
  for (const auto& [id, T] : T_map_node) {
    const graph::Node* node = store.node(id);
    if (node != nullptr && (!newest || node->stamp > *newest)) newest = node->stamp;
  }
  return newest;
}

graph::Placement place(const store::Store& store, const GeoPoint& origin,
                       const graph::PlacementConfig& config, std::span<const NodeId> covariance_of) {
  return graph::compute_placement(nodes_of(store), alignments_of(store), LocalFrame(origin), config,
                                  covariance_of);
}

store::MergedMap main_map(store::Store& store, const graph::Placement& placement,
                          const store::MergeConfig& config) {
  return merged_map(store, map_parts(nodes_of(store), placement).main.T_map_node, config);
}

}  // namespace fleetmap::output
