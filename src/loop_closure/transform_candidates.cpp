#include "transform_candidates.hpp"

#include <algorithm>

namespace fleetmap::loop_closure {
namespace {

/// Rejections in a row after which a transform is distrusted.
constexpr int kMaxRejections = 5;
/// By so much a transform differs from another one.
constexpr double kOtherTranslation = 2.0;  // m
constexpr double kOtherRotation = 0.1;     // rad

bool differ(const Pose& T_before, const Pose& T_now) {
  const Pose T = T_before.inverse() * T_now;
  return T.translation().norm() > kOtherTranslation || so3_log(T.linear()).norm() > kOtherRotation;
}

}  // namespace

std::vector<LoopCandidate> TransformCandidates::propose(const graph::Node& node) {
  transforms_.add(node);
  std::vector<LoopCandidate> candidates;
  for (const AgentId& other : nodes_.partners_of(node.id.agent)) {
    if (auto candidate = search(node.id, other)) candidates.push_back(*candidate);
  }
  if (nodes_.nodes_after(node.id) > 0) search_later_nodes(node.id);
  return candidates;
}

std::vector<LoopCandidate> TransformCandidates::propose_pending(std::size_t searches) {
  std::vector<LoopCandidate> candidates;
  for (; searches > 0 && !pending_.empty(); --searches) {
    const auto [node, other] = *pending_.begin();
    pending_.erase(pending_.begin());
    if (auto candidate = search(node, other)) candidates.push_back(*candidate);
  }
  return candidates;
}

void TransformCandidates::remove(const NodeId& node) {
  std::erase_if(pending_, [&](const auto& search) { return search.first == node; });
}

std::optional<LoopCandidate> TransformCandidates::search(const NodeId& node, const AgentId& other) const {
  if (!nodes_.any_unlocated()) return std::nullopt;
  const auto nearest = transforms_.nearest(node, other);
  if (!nearest || nearest->distance > config_.max_radius) return std::nullopt;
  const NodePair pair = other == self_ ? NodePair{nearest->id, node} : NodePair{node, nearest->id};
  if (!usable(pair)) return std::nullopt;
  // In the same direction at both robots, so that both compute the same radius.
  const auto T = transforms_.between(std::min(pair.ours, pair.theirs), std::max(pair.ours, pair.theirs));
  if (!T) return std::nullopt;
  const double distance = T->T_a_b.translation().head<2>().norm();
  const double radius = place::search_radius(T->covariance, config_);
  if (distance > radius) return std::nullopt;
  return LoopCandidate{pair.ours, pair.theirs, LoopCandidate::Origin::kTransform, distance, radius};
}

void TransformCandidates::search_later_nodes(const NodeId& node) {
  if (known_.empty()) return;
  const std::vector<AgentId> partners = nodes_.partners_of(node.agent);
  const auto& entries = nodes_.entries();
  for (auto later = entries.upper_bound(node); later != entries.end() && later->first.agent == node.agent;
       ++later) {
    for (const AgentId& other : partners) pending_.emplace(later->first, other);
  }
}

void TransformCandidates::search_frames(const FrameTransforms::FramePair& frames) {
  for (const auto& [id, entry] : nodes_.entries()) {
    if (entry.frame == frames.first) pending_.emplace(id, frames.second.agent);
    if (entry.frame == frames.second) pending_.emplace(id, self_);
  }
}

std::vector<FrameTransforms::FramePair> TransformCandidates::on_used_alignments(
    std::span<const graph::Alignment> used) {
  transforms_.use(used);
  std::vector<FrameTransforms::FramePair> changed;
  if (!nodes_.any_unlocated()) return changed;
  const auto before = std::exchange(known_, {});
  for (const auto& [frames, T_ours_theirs] : transforms_.known()) {
    const AgentId& peer = frames.second.agent;
    if (frames.first.agent != self_ || peer == self_) continue;
    const auto known = before.find(frames);
    const bool same = known != before.end() && !differ(known->second.T_ours_theirs, T_ours_theirs);
    if (known != before.end() && !same) rejections_.erase(peer);
    const bool trusted = !distrusted(peer);
    known_.emplace(frames, Known{T_ours_theirs, trusted});
    if (!trusted || (same && known->second.searched)) continue;
    search_frames(frames);
    changed.push_back(frames);
  }
  return changed;
}

bool TransformCandidates::on_rejected(const AgentId& peer) {
  if (++rejections_[peer] != kMaxRejections) return false;
  for (auto& [frames, known] : known_) {
    if (frames.second.agent == peer) known.searched = false;
  }
  return true;
}

bool TransformCandidates::distrusted(const AgentId& peer) const {
  const auto rejections = rejections_.find(peer);
  return rejections != rejections_.end() && rejections->second >= kMaxRejections;
}

bool TransformCandidates::usable(const NodePair& pair) const {
  return nodes_.lacks_position(pair) && !distrusted(pair.theirs.agent);
}

std::optional<UncertainPose> TransformCandidates::transform(const NodePair& pair) const {
  return usable(pair) ? transforms_.between(pair.ours, pair.theirs) : std::nullopt;
}

}  // namespace fleetmap::loop_closure
