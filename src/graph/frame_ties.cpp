#include "fleetmap/graph/frame_ties.hpp"

#include <algorithm>
#include <cstdlib>

namespace fleetmap::graph {
namespace {

std::int64_t apart(const NodeId& a, const NodeId& b) {
  return std::abs(static_cast<std::int64_t>(a.seq) - static_cast<std::int64_t>(b.seq));
}

}  // namespace

void FrameTies::add(const Node& node) {
  places_.try_emplace(node.id, Place{node.frame(), node.T_odom_base, node.odom_covariance});
}

void FrameTies::use(std::span<const Alignment> used) {
  ties_.clear();
  for (const Alignment& alignment : used) {
    const auto i = places_.find(alignment.i);
    const auto j = places_.find(alignment.j);
    if (i == places_.end() || j == places_.end() || i->second.frame == j->second.frame) continue;
    const UncertainPose T_i_j{alignment.best().T_i_j, alignment.best().covariance};
    ties_[{i->second.frame, j->second.frame}].push_back({alignment.i, alignment.j, T_i_j});
    ties_[{j->second.frame, i->second.frame}].push_back({alignment.j, alignment.i, inverse(T_i_j)});
  }
  std::erase_if(ties_, [](const auto& entry) { return entry.second.size() < kLeast; });
}

Pose FrameTies::T_odom_odom(const Tie& tie) const {
  return places_.at(tie.i).T_odom_base * tie.T_i_j.T_a_b * places_.at(tie.j).T_odom_base.inverse();
}

std::map<FrameTies::FramePair, Pose> FrameTies::tied() const {
  std::map<FramePair, Pose> frames;
  for (const auto& [pair, ties] : ties_) frames.emplace(pair, T_odom_odom(ties.front()));
  return frames;
}

std::optional<UncertainPose> FrameTies::odometry(const NodeId& from, const NodeId& to) const {
  const auto [first, last] = std::minmax(from, to);
  auto place = places_.find(first);
  if (place == places_.end()) return std::nullopt;
  UncertainPose T_first_here;
  while (place->first != last) {
    const auto next = std::next(place);
    if (next == places_.end() || next->first != NodeId{first.agent, place->first.seq + 1} ||
        next->second.frame != place->second.frame)
      return std::nullopt;
    T_first_here = compose(T_first_here, {place->second.T_odom_base.inverse() * next->second.T_odom_base,
                                          next->second.odom_covariance});
    place = next;
  }
  return from == first ? T_first_here : inverse(T_first_here);
}

std::optional<UncertainPose> FrameTies::between(const NodeId& i, const NodeId& j) const {
  const auto place_i = places_.find(i);
  const auto place_j = places_.find(j);
  if (place_i == places_.end() || place_j == places_.end()) return std::nullopt;
  const auto ties = ties_.find({place_i->second.frame, place_j->second.frame});
  if (ties == ties_.end()) return std::nullopt;
  std::vector<std::pair<std::int64_t, const Tie*>> nearest;
  for (const Tie& tie : ties->second) nearest.emplace_back(apart(i, tie.i) + apart(tie.j, j), &tie);
  std::ranges::stable_sort(nearest, {}, &std::pair<std::int64_t, const Tie*>::first);
  for (const auto& [steps, tie] : nearest) {
    const auto there = odometry(i, tie->i);
    const auto on = odometry(tie->j, j);
    if (there && on) return compose(compose(*there, tie->T_i_j), *on);
  }
  return std::nullopt;
}

std::optional<FrameTies::Neighbour> FrameTies::nearest(const NodeId& node, const AgentId& agent) const {
  const auto self = places_.find(node);
  if (self == places_.end()) return std::nullopt;
  std::optional<Neighbour> nearest;
  for (const auto& [frames, ties] : ties_) {
    if (frames.first != self->second.frame || frames.second.agent != agent) continue;
    const Tie& tie = *std::ranges::min_element(ties, {}, [&](const Tie& tie) { return apart(node, tie.i); });
    const Pose T_node_odom = self->second.T_odom_base.inverse() * T_odom_odom(tie);
    for (auto place = places_.lower_bound({agent, 0}); place != places_.end() && place->first.agent == agent;
         ++place) {
      if (place->second.frame != frames.second) continue;
      const Eigen::Vector3d p = T_node_odom * place->second.T_odom_base.translation();
      const double distance = p.head<2>().norm();
      if (!nearest || distance < nearest->distance) nearest = Neighbour{place->first, distance};
    }
  }
  return nearest;
}

}  // namespace fleetmap::graph
