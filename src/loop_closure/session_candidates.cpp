#include "session_candidates.hpp"

#include <algorithm>
#include <utility>

#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {
namespace {

/// Accepted registrations until a session counts as joined. Among repeated rows one descriptor match may be
/// one row off; of several that agree the graph rejects the wrong one. By G one is enough.
constexpr int kMinByDescriptor = 3;

using Side = DescriptorCandidates::Side;

}  // namespace

void SessionCandidates::begin(const std::vector<const graph::Node*>& earlier) {
  earlier_.clear();
  for (const graph::Node* node : earlier) earlier_[node->session].nodes.push_back(node);
}

void SessionCandidates::add_earlier(const graph::Node& node) {
  Session& session = earlier_[node.session];
  session.nodes.push_back(&node);
  if (session.descriptors) session.descriptors->propose(node, located(node), Side::kTheirs);
}

std::optional<LoopCandidate> SessionCandidates::propose(const graph::Node& node) {
  auto candidate = nearest(node);
  auto match = best_match(node);  // in any case: it adds the node to the descriptors
  return candidate ? candidate : match;
}

void SessionCandidates::on_accepted(const graph::Node& earlier, const graph::Node& later) {
  const auto session = earlier_.find(earlier.session);
  if (session == earlier_.end()) return;
  ++(located(earlier) && located(later) ? session->second.joined_by_position
                                        : session->second.joined_by_descriptor);
}

bool SessionCandidates::located(const graph::Node& node) const {
  return place::has_known_position(node.G, config_.max_sigma_m);
}

std::optional<LoopCandidate> SessionCandidates::nearest(const graph::Node& node) const {
  if (!located(node)) return std::nullopt;
  std::optional<LoopCandidate> best;
  double distance = config_.proximity.max_radius;
  for (const auto& [number, session] : earlier_) {
    if (session.joined_by_position > 0) continue;
    for (const graph::Node* other : session.nodes) {
      if (!located(*other)) continue;
      const double d = haversine_distance(other->G->position, node.G->position);
      if (d >= distance) continue;
      best = LoopCandidate{other->id, node.id, LoopCandidate::Origin::kPosition, d,
                           config_.proximity.max_radius};
      distance = d;
    }
  }
  return best;
}

std::optional<LoopCandidate> SessionCandidates::best_match(const graph::Node& node) {
  std::optional<LoopCandidate> best;
  for (auto& [number, session] : earlier_) {
    if (session.joined_by_position > 0 || session.joined_by_descriptor >= kMinByDescriptor) continue;
    const auto is_located = [&](const graph::Node* other) { return located(*other); };
    if (located(node) && std::ranges::all_of(session.nodes, is_located)) continue;
    if (!session.descriptors) {
      session.descriptors.emplace(config_.descriptors, config_.proximity.max_radius);
      for (const graph::Node* other : session.nodes)
        session.descriptors->propose(*other, located(*other), Side::kTheirs);
    }
    for (LoopCandidate& match : session.descriptors->propose(node, located(node), Side::kOurs)) {
      if (best && best->match_score >= match.match_score) continue;
      best = match;
    }
  }
  // The earlier node is the target.
  if (best) std::swap(best->target, best->source);
  return best;
}

}  // namespace fleetmap::loop_closure
