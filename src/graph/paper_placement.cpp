#include "paper_placement.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "global_fit.hpp"

namespace fleetmap::graph {
namespace {

using FramePair = std::pair<FrameId, FrameId>;

auto preference(const Alignment& a) { return std::tie(a.best().rmse, a.computed_by, a.seq); }

std::vector<Node> sorted_by_id(std::span<const Node> nodes) {
  std::vector<Node> sorted(nodes.begin(), nodes.end());
  std::ranges::sort(sorted, {}, &Node::id);
  return sorted;
}

/// The least E_ij of every pair of odometry frames, best pair first. Ambiguous alignments do not count, and
/// those of unknown nodes wait for their nodes.
std::vector<Alignment> best_of_each_pair(std::span<const Alignment> alignments,
                                         const std::map<NodeId, const Node*>& by_id, double max_rmse) {
  std::map<FramePair, const Alignment*> best;
  for (const Alignment& a : alignments) {
    if (a.ambiguous() || a.best().rmse > max_rmse || !by_id.contains(a.i) || !by_id.contains(a.j)) continue;
    const FrameId frame_i = by_id.at(a.i)->frame();
    const FrameId frame_j = by_id.at(a.j)->frame();
    if (frame_i == frame_j) continue;
    const Alignment*& slot =
        best[frame_i < frame_j ? FramePair(frame_i, frame_j) : FramePair(frame_j, frame_i)];
    if (slot == nullptr || preference(a) < preference(*slot)) slot = &a;
  }
  std::vector<Alignment> selected;
  for (const auto& [pair, alignment] : best) selected.push_back(*alignment);
  std::ranges::sort(selected,
                    [](const Alignment& a, const Alignment& b) { return preference(a) < preference(b); });
  return selected;
}

/// Odometry frames joined so far, each with its pose in the root frame of its group.
struct Groups {
  std::map<FrameId, FrameId> root;
  std::map<FrameId, Pose> T_root_odom;

  /// Joins the groups of both frames; false if they are one already.
  bool join(const FrameId& i, const FrameId& j, const Pose& T_odom_i_odom_j) {
    const FrameId root_i = root.at(i);
    const FrameId root_j = root.at(j);
    if (root_i == root_j) return false;
    const Pose T_root_i_root_j = T_root_odom.at(i) * T_odom_i_odom_j * T_root_odom.at(j).inverse();
    for (auto& [frame, its_root] : root) {
      if (its_root != root_j) continue;
      its_root = root_i;
      T_root_odom.at(frame) = T_root_i_root_j * T_root_odom.at(frame);
    }
    return true;
  }
};

}  // namespace

Placement place_by_min_rmse(std::span<const Node> unsorted_nodes, std::span<const Alignment> alignments,
                            const LocalFrame& site, const PaperPlacementConfig& config) {
  const std::vector<Node> nodes = sorted_by_id(unsorted_nodes);
  std::map<NodeId, const Node*> by_id;
  Groups groups;
  for (const Node& node : nodes) {
    by_id[node.id] = &node;
    groups.root.try_emplace(node.frame(), node.frame());
    groups.T_root_odom.try_emplace(node.frame(), Pose::Identity());
  }

  Placement placement;
  for (const Alignment& a : best_of_each_pair(alignments, by_id, config.max_rmse)) {
    const Node& i = *by_id.at(a.i);
    const Node& j = *by_id.at(a.j);
    const Pose T_odom_i_odom_j = i.T_odom_base * a.best().T_i_j * j.T_odom_base.inverse();
    if (groups.join(i.frame(), j.frame(), T_odom_i_odom_j)) placement.used.push_back(a);
  }

  std::map<FrameId, std::vector<FrameId>> members;
  for (const auto& [frame, root] : groups.root) members[root].push_back(frame);
  for (const auto& [root, frames] : members) {
    std::vector<Node> group_nodes;
    std::vector<Pose> T_root_node;
    for (const Node& node : nodes) {
      if (groups.root.at(node.frame()) != root) continue;
      group_nodes.push_back(node);
      T_root_node.push_back(groups.T_root_odom.at(node.frame()) * node.T_odom_base);
    }
    const Pose T_enu_root = fit_to_global_poses(group_nodes, T_root_node, site, config.gps_correlation_time);
    for (const FrameId& frame : frames)
      placement.T_enu_odom[frame] = T_enu_root * groups.T_root_odom.at(frame);
    for (std::size_t k = 0; k < group_nodes.size(); ++k) {
      placement.T_enu_node[group_nodes[k].id] = T_enu_root * T_root_node[k];
    }
    placement.components.push_back(frames);
  }
  std::ranges::sort(placement.components);
  return placement;
}

}  // namespace fleetmap::graph
