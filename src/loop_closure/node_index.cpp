#include "node_index.hpp"

#include <algorithm>

#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {

bool NodeIndex::located(const graph::Node& node) const {
  return place::has_known_position(node.G, max_sigma_m_);
}

bool NodeIndex::add(const graph::Node& node) {
  Entry entry{std::nullopt, node.frame(), node.T_odom_base.translation()};
  if (located(node)) entry.position = node.G->position;
  if (!entries_.emplace(node.id, entry).second) return false;
  std::uint32_t& newest = newest_[node.id.agent][node.session];
  newest = std::max(newest, node.id.seq);
  any_unlocated_ = any_unlocated_ || !entry.position;
  return true;
}

const NodeIndex::Entry* NodeIndex::find(const NodeId& node) const {
  const auto entry = entries_.find(node);
  return entry == entries_.end() ? nullptr : &entry->second;
}

bool NodeIndex::lacks_position(const NodePair& pair) const {
  const Entry* ours = find(pair.ours);
  const Entry* theirs = find(pair.theirs);
  return ours != nullptr && theirs != nullptr && !(ours->position && theirs->position);
}

std::uint32_t NodeIndex::nodes_after(const NodeId& node) const {
  const Entry* entry = find(node);
  return entry == nullptr ? 0 : newest_.at(node.agent).at(entry->frame.session) - node.seq;
}

std::vector<AgentId> NodeIndex::partners_of(const AgentId& agent) const {
  if (agent != self_) return {self_};
  std::vector<AgentId> peers;
  for (const auto& [peer, newest] : newest_) {
    if (peer != self_) peers.push_back(peer);
  }
  return peers;
}

bool NodeIndex::near(const NodeId& a, const NodeId& b, double limit) const {
  const Entry* at_a = find(a);
  const Entry* at_b = find(b);
  if (at_a == nullptr || at_b == nullptr) return false;
  if (at_a->position && at_b->position) return haversine_distance(*at_a->position, *at_b->position) < limit;
  return at_a->frame == at_b->frame && (at_a->p_odom - at_b->p_odom).norm() < limit;
}

}  // namespace fleetmap::loop_closure
