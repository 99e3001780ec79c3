#include "fleetmap/graph/placement.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace fleetmap::graph {
namespace {

using AgentPair = std::pair<AgentId, AgentId>;

auto preference(const Alignment& a) { return std::tie(a.rmse, a.computed_by, a.seq); }

std::vector<Node> sorted_by_id(std::span<const Node> nodes) {
  std::vector<Node> sorted(nodes.begin(), nodes.end());
  std::ranges::sort(sorted, {}, &Node::id);
  return sorted;
}

/// The least E_ij of every pair of agents, best pair first. Alignments of unknown nodes wait for their nodes.
std::vector<Alignment> best_of_each_pair(std::span<const Alignment> alignments,
                                         const std::map<NodeId, const Node*>& by_id, double max_rmse) {
  std::map<AgentPair, const Alignment*> best;
  for (const Alignment& a : alignments) {
    const bool usable =
        a.i.agent != a.j.agent && a.rmse <= max_rmse && by_id.contains(a.i) && by_id.contains(a.j);
    if (!usable) continue;
    const Alignment*& slot = best[std::minmax(a.i.agent, a.j.agent)];
    if (slot == nullptr || preference(a) < preference(*slot)) slot = &a;
  }
  std::vector<Alignment> chosen;
  for (const auto& [pair, alignment] : best) chosen.push_back(*alignment);
  std::ranges::sort(chosen,
                    [](const Alignment& a, const Alignment& b) { return preference(a) < preference(b); });
  return chosen;
}

/// Agents joined so far, each with its odometry frame in that of its group's first agent.
struct Groups {
  std::map<AgentId, AgentId> root;
  std::map<AgentId, Pose> T_root_odom;

  /// Joins the groups of both agents; false if they are one already.
  bool join(const AgentId& i, const AgentId& j, const Pose& T_odom_i_odom_j) {
    const AgentId root_i = root.at(i);
    const AgentId root_j = root.at(j);
    if (root_i == root_j) return false;
    const Pose T_root_i_root_j = T_root_odom.at(i) * T_odom_i_odom_j * T_root_odom.at(j).inverse();
    for (auto& [agent, its_root] : root) {
      if (its_root != root_j) continue;
      its_root = root_i;
      T_root_odom.at(agent) = T_root_i_root_j * T_root_odom.at(agent);
    }
    return true;
  }
};

}  // namespace

Placement place_by_least_rmse(std::span<const Node> unsorted_nodes, std::span<const Alignment> alignments,
                              const LocalFrame& site, const PaperPlacementConfig& config) {
  const std::vector<Node> nodes = sorted_by_id(unsorted_nodes);
  std::map<NodeId, const Node*> by_id;
  Groups groups;
  for (const Node& node : nodes) {
    by_id[node.id] = &node;
    groups.root.try_emplace(node.id.agent, node.id.agent);
    groups.T_root_odom.try_emplace(node.id.agent, Pose::Identity());
  }

  Placement placement;
  for (const Alignment& a : best_of_each_pair(alignments, by_id, config.max_rmse)) {
    const Pose T_odom_i_odom_j = by_id.at(a.i)->T_odom_base * a.T_i_j * by_id.at(a.j)->T_odom_base.inverse();
    if (groups.join(a.i.agent, a.j.agent, T_odom_i_odom_j)) placement.used.push_back(a);
  }

  std::map<AgentId, std::vector<AgentId>> members;
  for (const auto& [agent, root] : groups.root) members[root].push_back(agent);
  for (const auto& [root, agents] : members) {
    std::vector<Node> group_nodes;
    std::vector<Pose> T_root_node;
    for (const Node& node : nodes) {
      if (groups.root.at(node.id.agent) != root) continue;
      group_nodes.push_back(node);
      T_root_node.push_back(groups.T_root_odom.at(node.id.agent) * node.T_odom_base);
    }
    const Pose T_enu_root = fit_to_global_poses(group_nodes, T_root_node, site, config.gps_correlation_time);
    for (const AgentId& agent : agents)
      placement.T_enu_odom[agent] = T_enu_root * groups.T_root_odom.at(agent);
    for (std::size_t k = 0; k < group_nodes.size(); ++k) {
      placement.T_enu_node[group_nodes[k].id] = T_enu_root * T_root_node[k];
    }
    placement.components.push_back(agents);
  }
  std::ranges::sort(placement.components);
  return placement;
}

}  // namespace fleetmap::graph
