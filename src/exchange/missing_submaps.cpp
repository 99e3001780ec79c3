#include "missing_submaps.hpp"

#include <algorithm>
#include <chrono>

namespace fleetmap::exchange {
namespace {

/// A holder of the submap includes it in its digests within this time after the node was stored.
constexpr Duration kAnnounced = std::chrono::seconds(30);

}  // namespace

bool MissingSubmaps::complete(const store::Store& store, const Membership& members,
                              const NeighbourTable& neighbours, const std::set<AgentId>& without) const {
  if (store.submap_set().includes(store.node_set())) return true;
  const auto is_lost = [&](const NodeId& id) {
    return without.contains(id.agent) && std::ranges::all_of(members.fleet(), [&](const AgentId& agent) {
             return agent == members.self() || without.contains(agent) || neighbours.lacks(agent, id);
           });
  };
  return std::ranges::all_of(store.nodes(), [&](const auto& entry) {
    return store.has_submap(entry.first) || is_lost(entry.first) ||
           is_denied(entry.first, members, neighbours, without);
  });
}

bool MissingSubmaps::is_denied(const NodeId& node, const Membership& members,
                               const NeighbourTable& neighbours, const std::set<AgentId>& without) const {
  const auto since = since_.find(node);
  if (since == since_.end()) return false;
  return std::ranges::all_of(members.fleet(), [&](const AgentId& agent) {
    if (agent == members.self()) return true;
    return without.contains(agent) ? neighbours.lacks(agent, node)
                                   : neighbours.lacks_since(agent, node, since->second + kAnnounced);
  });
}

}  // namespace fleetmap::exchange
