#include "descriptor_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace fleetmap::loop_closure {
namespace {

constexpr std::size_t kMaxMatches = 400;  // of two frames; the oldest are dropped

}  // namespace

std::vector<LoopCandidate> DescriptorCandidates::propose(const graph::Node& node, bool located, Side side) {
  const Result<place::Descriptor> descriptor = place::Descriptor::decode(node.descriptor);
  if (!descriptor) return {};
  Keyframes& keyframes = keyframes_[{side, node.id.agent}];
  std::vector<Keyframe>& track = keyframes.all;
  const auto last = std::find_if(track.rbegin(), track.rend(),
                                 [&](const Keyframe& other) { return other.frame == node.frame(); });
  if (last != track.rend() &&
      (last->T_odom_base.translation() - node.T_odom_base.translation()).norm() < config_.spacing_m) {
    return {};
  }
  const Keyframe query{node.id, node.frame(), located, node.T_odom_base, node.up_in_base, *descriptor};
  track.push_back(query);
  keyframes.any_unlocated |= !located;
  std::vector<LoopCandidate> candidates;
  for (const auto& [other, theirs] : keyframes_) {
    if (other.first == side || (located && !theirs.any_unlocated)) continue;
    std::optional<LoopCandidate> best;
    for (const auto& [frames, match] : compare(query, other)) {
      const double support = support_of(frames, match);
      const bool sure = match.similarity >= config_.sure_similarity || support >= config_.min_support;
      const double score = match.similarity + support;
      if (sure && match.similarity >= config_.min_similarity && (!best || score > best->match_score)) {
        const NodePair pair =
            side == Side::kOurs ? NodePair{match.query, match.other} : NodePair{match.other, match.query};
        best = LoopCandidate{pair.ours,      pair.theirs, LoopCandidate::Origin::kDescriptor,
                             match.distance, radius_,     score};
      }
      std::vector<Match>& kept = matches_[frames];
      if (kept.size() >= kMaxMatches) kept.erase(kept.begin());
      kept.push_back(match);
    }
    if (best) candidates.push_back(*best);
  }
  return candidates;
}

std::vector<const DescriptorCandidates::Keyframe*> DescriptorCandidates::comparable(
    const Keyframe& query, const Track& other) const {
  std::vector<std::pair<int, const Keyframe*>> ranked;
  for (const Keyframe& keyframe : keyframes_.at(other).all) {
    if (query.located && keyframe.located) continue;
    ranked.emplace_back(std::abs(keyframe.descriptor.occupied() - query.descriptor.occupied()), &keyframe);
  }
  std::ranges::sort(ranked, [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second->id) < std::pair(b.first, b.second->id);
  });
  std::vector<const Keyframe*> best;
  for (const auto& [difference, keyframe] : ranked) {
    if (best.size() == config_.max_compared) break;
    best.push_back(keyframe);
  }
  return best;
}

std::vector<std::pair<DescriptorCandidates::FramePair, DescriptorCandidates::Match>>
DescriptorCandidates::compare(const Keyframe& query, const Track& other) const {
  const bool query_is_ours = other.first == Side::kTheirs;
  const std::vector<const Keyframe*> keyframes = comparable(query, other);
  if (keyframes.empty()) return {};
  std::vector<std::pair<FramePair, Match>> matches;
  const place::DescriptorQuery prepared(query.descriptor);
  for (const Keyframe* keyframe : keyframes) {
    const place::DescriptorMatch compared = prepared.compare(keyframe->descriptor);
    if (compared.similarity <= 0.0) continue;
    const Pose T_other_query = place::relative_pose(compared, keyframe->up, query.up);
    const Pose T = keyframe->T_odom_base * T_other_query * query.T_odom_base.inverse();
    Match match{query.id, keyframe->id, compared.similarity, compared.translation.norm()};
    match.T_ours_theirs = query_is_ours ? T.inverse() : T;
    match.theirs = (query_is_ours ? *keyframe : query).T_odom_base.translation();
    matches.emplace_back(
        query_is_ours ? FramePair(query.frame, keyframe->frame) : FramePair(keyframe->frame, query.frame),
        match);
  }
  std::ranges::stable_sort(
      matches, [](const auto& a, const auto& b) { return a.second.similarity > b.second.similarity; });
  if (matches.size() > config_.kept) matches.resize(config_.kept);
  return matches;
}

double DescriptorCandidates::support_of(const FramePair& frames, const Match& match) const {
  const auto kept = matches_.find(frames);
  if (kept == matches_.end()) return 0.0;
  std::map<NodeId, double> best;
  for (const Match& other : kept->second) {
    if (other.query == match.query || other.query == match.other) continue;
    const Eigen::Vector3d apart = other.T_ours_theirs * match.theirs - match.T_ours_theirs * match.theirs;
    if (apart.head<2>().norm() > config_.agree_m) continue;
    const Eigen::Matrix3d turn = other.T_ours_theirs.linear() * match.T_ours_theirs.linear().transpose();
    if (so3_log(turn).norm() > config_.agree_rad) continue;
    double& similarity = best[other.query];
    similarity = std::max(similarity, other.similarity);
  }
  double support = 0.0;
  for (const auto& [id, similarity] : best) support += similarity;
  return support;
}

}  // namespace fleetmap::loop_closure
