#include "frame_transforms.hpp"

#include <algorithm>
#include <cstdlib>

namespace fleetmap::loop_closure {
namespace {

std::int64_t apart(const NodeId& a, const NodeId& b) {
  return std::abs(static_cast<std::int64_t>(a.seq) - static_cast<std::int64_t>(b.seq));
}

}  // namespace

void FrameTransforms::add(const graph::Node& node) {
  keyframes_.try_emplace(node.id, Keyframe{node.frame(), node.T_odom_base, node.odom_covariance});
}

void FrameTransforms::use(std::span<const graph::Alignment> used) {
  constraints_.clear();
  for (const graph::Alignment& alignment : used) {
    const auto i = keyframes_.find(alignment.i);
    const auto j = keyframes_.find(alignment.j);
    if (i == keyframes_.end() || j == keyframes_.end() || i->second.frame == j->second.frame) continue;
    const UncertainPose T_i_j{alignment.best().T_i_j, alignment.best().covariance};
    constraints_[{i->second.frame, j->second.frame}].push_back({alignment.i, alignment.j, T_i_j});
    constraints_[{j->second.frame, i->second.frame}].push_back({alignment.j, alignment.i, inverse(T_i_j)});
  }
  std::erase_if(constraints_, [](const auto& entry) { return entry.second.size() < kMinAlignments; });
}

Pose FrameTransforms::T_odom_odom(const Constraint& constraint) const {
  return keyframes_.at(constraint.i).T_odom_base * constraint.T_i_j.T_a_b *
         keyframes_.at(constraint.j).T_odom_base.inverse();
}

std::map<FrameTransforms::FramePair, Pose> FrameTransforms::known() const {
  std::map<FramePair, Pose> frames;
  for (const auto& [pair, constraints] : constraints_) frames.emplace(pair, T_odom_odom(constraints.front()));
  return frames;
}

std::optional<UncertainPose> FrameTransforms::odometry(const NodeId& from, const NodeId& to) const {
  const auto [first, last] = std::minmax(from, to);
  auto keyframe = keyframes_.find(first);
  if (keyframe == keyframes_.end()) return std::nullopt;
  UncertainPose T_first_here;
  while (keyframe->first != last) {
    const auto next = std::next(keyframe);
    if (next == keyframes_.end() || next->first != NodeId{first.agent, keyframe->first.seq + 1} ||
        next->second.frame != keyframe->second.frame)
      return std::nullopt;
    T_first_here = compose(T_first_here, {keyframe->second.T_odom_base.inverse() * next->second.T_odom_base,
                                          next->second.odom_covariance});
    keyframe = next;
  }
  return from == first ? T_first_here : inverse(T_first_here);
}

std::optional<UncertainPose> FrameTransforms::between(const NodeId& i, const NodeId& j) const {
  const auto frame_i = keyframes_.find(i);
  const auto frame_j = keyframes_.find(j);
  if (frame_i == keyframes_.end() || frame_j == keyframes_.end()) return std::nullopt;
  const auto constraints = constraints_.find({frame_i->second.frame, frame_j->second.frame});
  if (constraints == constraints_.end()) return std::nullopt;
  std::vector<std::pair<std::int64_t, const Constraint*>> nearest;
  for (const Constraint& constraint : constraints->second)
    nearest.emplace_back(apart(i, constraint.i) + apart(constraint.j, j), &constraint);
  std::ranges::stable_sort(nearest, {}, &std::pair<std::int64_t, const Constraint*>::first);
  for (const auto& [steps, constraint] : nearest) {
    const auto there = odometry(i, constraint->i);
    const auto on = odometry(constraint->j, j);
    if (there && on) return compose(compose(*there, constraint->T_i_j), *on);
  }
  return std::nullopt;
}

std::optional<FrameTransforms::Neighbour> FrameTransforms::nearest(const NodeId& node,
                                                                   const AgentId& agent) const {
  const auto self = keyframes_.find(node);
  if (self == keyframes_.end()) return std::nullopt;
  std::optional<Neighbour> nearest;
  for (const auto& [frames, constraints] : constraints_) {
    if (frames.first != self->second.frame || frames.second.agent != agent) continue;
    const Constraint& constraint = *std::ranges::min_element(
        constraints, {}, [&](const Constraint& constraint) { return apart(node, constraint.i); });
    const Pose T_node_odom = self->second.T_odom_base.inverse() * T_odom_odom(constraint);
    for (auto keyframe = keyframes_.lower_bound({agent, 0});
         keyframe != keyframes_.end() && keyframe->first.agent == agent; ++keyframe) {
      if (keyframe->second.frame != frames.second) continue;
      const Eigen::Vector3d p = T_node_odom * keyframe->second.T_odom_base.translation();
      const double distance = p.head<2>().norm();
      if (!nearest || distance < nearest->distance) nearest = Neighbour{keyframe->first, distance};
    }
  }
  return nearest;
}

}  // namespace fleetmap::loop_closure
