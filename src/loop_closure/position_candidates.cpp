#include "position_candidates.hpp"

namespace fleetmap::loop_closure {

std::vector<LoopCandidate> PositionCandidates::propose(const graph::Node& node) {
  Track& own = tracks_[node.id.agent];
  if (own.tree.insert(node.G->position) == place::BallTree::kRefused) return {};
  own.ids.push_back(node.id);
  const bool is_ours = node.id.agent == self_;
  std::vector<LoopCandidate> candidates;
  for (const auto& [agent, track] : tracks_) {
    if ((agent == self_) == is_ours) continue;
    const auto found = place::find_proximity(track.tree, *node.G, config_);
    if (!found) continue;
    const NodeId& partner = track.ids[found->nearest.index];
    candidates.push_back({is_ours ? node.id : partner, is_ours ? partner : node.id,
                          LoopCandidate::Origin::kPosition, found->nearest.distance, found->radius});
  }
  return candidates;
}

}  // namespace fleetmap::loop_closure
