#include "fleetmap/agent/session_ties.hpp"

#include <algorithm>

#include "fleetmap/agent/encounter_registration.hpp"

namespace fleetmap::agent {
namespace {

/// In rows that repeat, one pair of places that look alike may be one row off; of some that agree the graph
/// can tell. Where GPS says which place it is, one will do.
constexpr int kTiesByLooks = 3;

using exchange::Lookalikes;

}  // namespace

void SessionTies::begin(const std::vector<const graph::Node*>& earlier) {
  earlier_.clear();
  for (const graph::Node* node : earlier) earlier_[node->session].nodes.push_back(node);
}

void SessionTies::add_earlier(const graph::Node& node) {
  Session& session = earlier_[node.session];
  session.nodes.push_back(&node);
  if (session.lookalikes) session.lookalikes->add(node, located(node), Lookalikes::Side::kTheirs);
}

std::optional<SessionTies::Tie> SessionTies::on_own_node(const graph::Node& node) {
  const graph::Node* earlier = nearest(node);
  const graph::Node* alike = most_alike(node);  // in any case: it remembers the places
  if (earlier == nullptr) earlier = alike;
  if (earlier == nullptr) return std::nullopt;
  const auto prior = prior_of(*earlier, node, config_);
  if (!prior) return std::nullopt;
  return Tie{earlier, *prior};
}

void SessionTies::on_accepted(const graph::Node& earlier, const graph::Node& later) {
  const auto session = earlier_.find(earlier.session);
  if (session == earlier_.end()) return;
  ++(located(earlier) && located(later) ? session->second.by_place : session->second.by_looks);
}

bool SessionTies::located(const graph::Node& node) const {
  return place::tells_place(node.G, config_.max_sigma_m);
}

const graph::Node* SessionTies::nearest(const graph::Node& node) const {
  if (!located(node)) return nullptr;
  const graph::Node* best = nullptr;
  double least = config_.proximity.max_radius;
  for (const auto& [number, session] : earlier_) {
    if (session.by_place > 0) continue;
    for (const graph::Node* other : session.nodes) {
      if (!located(*other)) continue;
      const double distance = haversine_distance(other->G->position, node.G->position);
      if (distance >= least) continue;
      best = other;
      least = distance;
    }
  }
  return best;
}

const graph::Node* SessionTies::most_alike(const graph::Node& node) {
  std::optional<Lookalikes::Pair> best;
  const auto likeness = [](const Lookalikes::Pair& pair) { return pair.similarity + pair.support; };
  const graph::Node* most = nullptr;
  for (auto& [number, session] : earlier_) {
    if (session.by_place > 0 || session.by_looks >= kTiesByLooks) continue;
    const auto is_located = [&](const graph::Node* other) { return located(*other); };
    if (located(node) && std::ranges::all_of(session.nodes, is_located)) continue;
    if (!session.lookalikes) {
      session.lookalikes.emplace(config_.lookalikes);
      for (const graph::Node* other : session.nodes)
        session.lookalikes->add(*other, located(*other), Lookalikes::Side::kTheirs);
    }
    for (const auto& pair : session.lookalikes->add(node, located(node), Lookalikes::Side::kOurs)) {
      if (best && likeness(*best) >= likeness(pair)) continue;
      best = pair;
      most = *std::ranges::find(session.nodes, pair.other, &graph::Node::id);
    }
  }
  return most;
}

}  // namespace fleetmap::agent
