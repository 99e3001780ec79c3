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
  const auto is_lost = [&](const NodeId& id) {
    return without.contains(id.agent) && std::ranges::all_of(members.fleet(), [&](const AgentId& agent) {
             return agent == members.self() || without.contains(agent) || neighbours.lacks(agent, id);
           });
  };
  for (const SeqRange& lacking : store.node_set().minus(store.submap_set())) {
    for (NodeId id{lacking.agent, lacking.first}; id.seq < lacking.end; ++id.seq) {
      // A contested name has no node.
      if (store.node(id) != nullptr && !is_lost(id) && !is_denied(id, members, neighbours, without))
        return false;
    }
  }
  return true;
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
