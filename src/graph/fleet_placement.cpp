#include "fleet_placement.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>

#include "interpolated_nodes.hpp"
#include "problem/initial_estimate.hpp"
#include "problem/valid_items.hpp"
#include "rejection/outlier_rejection.hpp"

namespace fleetmap::graph {
namespace {

/// Input of every step.
struct Input {
  SortedItems items;
  std::vector<AgentId> computed_by;  ///< by alignment
  std::vector<NodeId> ends;          ///< of the alignments that can be used
  const LocalFrame& site;
  const FleetPlacementConfig& config;
};

/// The graph of some nodes, and what outlier rejection made of it.
struct Solution {
  ReducedGraph graph;
  std::vector<std::size_t> present;  ///< alignments whose nodes are in the graph
  Rejection rejection;
};

/// The result is filled in place, because its solver refers to its graph.
void solve(const Input& input, std::span<const Node* const> nodes, Solution& solution) {
  solution.graph = reduce(nodes, input.ends, input.site, input.config);
  solution.rejection = reject_outliers(
      solution.graph, candidates_of(input.items.alignments, solution.present, solution.graph, input.config),
      input.computed_by, initial_estimate(solution.graph, input.site, input.config));
}

/// Agents whose own GPS and odometry cannot be solved: each number is possible, but not all of them together.
std::set<AgentId> unsolvable_agents(const Input& input) {
  const std::span<const Node* const> nodes = input.items.nodes;
  std::set<AgentId> found;
  for (std::size_t first = 0, end = 0; first < nodes.size(); first = end) {
    const AgentId& agent = nodes[first]->id.agent;
    while (end < nodes.size() && nodes[end]->id.agent == agent) ++end;
    const ReducedGraph graph =
        reduce(nodes.subspan(first, end - first), input.ends, input.site, input.config);
    Estimate estimate = initial_estimate(graph, input.site, input.config);
    if (GraphSolver(graph, {}).solve(estimate, kMaxSteps) != GraphSolver::Outcome::converged)
      found.insert(agent);
  }
  return found;
}

// ---- parts of the placement

std::vector<AlignmentOutcome> outcomes(const Input& input, const Solution& solution) {
  std::vector<AlignmentOutcome> result;
  for (const Alignment* a : input.items.alignments)
    result.push_back({a->i, a->j, a->computed_by, a->seq, initial_status(*a, input.items.nodes), 0});
  const Rejection& rejection = solution.rejection;
  for (const std::size_t k : solution.present) {
    const Alignment& a = *input.items.alignments[k];
    if (rejection.quarantined.contains(input.computed_by[k]) || a.i.agent == rejection.contradicting ||
        a.j.agent == rejection.contradicting)
      result[k].status = AlignmentStatus::quarantined;
  }
  for (const auto& [alignment, status] : rejection.rejected) result[alignment].status = status;
  for (const auto& [alignment, candidate] : rejection.accepted) {
    result[alignment].status = AlignmentStatus::used;
    result[alignment].mode = rejection.candidates[candidate].mode;
  }
  return result;
}

std::map<AgentId, AlignmentStats> stats_by_agent(std::span<const AlignmentOutcome> outcomes,
                                                 const Rejection& rejection) {
  std::map<AgentId, AlignmentStats> result;
  for (const AlignmentOutcome& one : outcomes) {
    AlignmentStats& stats = result[one.computed_by];
    stats.used += one.status == AlignmentStatus::used;
    stats.rejected +=
        one.status == AlignmentStatus::against_gps || one.status == AlignmentStatus::against_others;
  }
  for (const auto& [agent, sets] : rejection.outlier_sets) result[agent].outlier_sets = sets;
  for (const AgentId& agent : rejection.quarantined) result[agent].quarantined = true;
  return result;
}

/// The accepted alignments, each with its accepted mode alone.
std::vector<Alignment> used_alignments(const Input& input, const Rejection& rejection) {
  std::vector<Alignment> used;
  for (const auto& [alignment, candidate] : rejection.accepted) {
    used.push_back(*input.items.alignments[alignment]);
    used.back().modes = {input.items.alignments[alignment]->modes[rejection.candidates[candidate].mode]};
  }
  return used;
}

std::vector<std::vector<FrameId>> components(const Solution& solution) {
  const auto& [graph, present, rejection] = solution;
  std::vector<std::size_t> group(graph.frames.size());
  std::iota(group.begin(), group.end(), 0u);
  for (const auto& [alignment, candidate] : rejection.accepted) {
    const auto [a, b] = rejection.candidates[candidate].frames;
    const std::size_t from = std::max(group[a], group[b]), to = std::min(group[a], group[b]);
    std::ranges::replace(group, from, to);
  }
  std::map<std::size_t, std::vector<FrameId>> members;
  for (std::size_t f = 0; f < group.size(); ++f) members[group[f]].push_back(graph.frames[f].id);
  std::vector<std::vector<FrameId>> result;
  for (const auto& [root, frames] : members) result.push_back(frames);
  return result;
}

void add_poses(const ReducedGraph& graph, const Estimate& estimate, Placement& placement) {
  const std::vector<Pose> T_enu = interpolated_poses(graph, estimate);
  auto& placed = placement.T_enu_node;
  for (std::size_t k = 0; k < T_enu.size(); ++k)
    placed.insert_or_assign(placed.end(), graph.nodes[k]->id, T_enu[k]);
  for (const FrameSpan& frame : graph.frames) {
    const Node& newest = *graph.nodes[frame.end - 1];
    placement.T_enu_odom[frame.id] = estimate.T_enu[frame.end_pose - 1] * newest.T_odom_base.inverse();
  }
}

/// Adds the nodes that are not part of the graph: each frame at the fit to its fixes, as a component of its
/// own.
void add_unsolvable(const Input& input, std::span<const Node* const> nodes, Placement& placement) {
  if (nodes.empty()) return;
  const ReducedGraph graph = reduce(nodes, std::span<const NodeId>(), input.site, input.config);
  add_poses(graph, initial_estimate(graph, input.site, input.config), placement);
  for (const FrameSpan& frame : graph.frames) placement.components.push_back({frame.id});
}

std::map<NodeId, Matrix6d> covariances(const Solution& solution, std::span<const NodeId> wanted) {
  std::map<NodeId, Matrix6d> result;
  if (wanted.empty() || !solution.rejection.solver) return result;
  const std::set<NodeId> ids(wanted.begin(), wanted.end());
  for (std::size_t k = 0; k < solution.graph.nodes.size(); ++k) {
    const NodeId& id = solution.graph.nodes[k]->id;
    if (ids.contains(id)) result[id] = covariance_of_node(solution.graph, *solution.rejection.solver, k);
  }
  return result;
}

}  // namespace

Placement place_by_fleet_graph(std::span<const Node> nodes, std::span<const Alignment> alignments,
                               const LocalFrame& site, const FleetPlacementConfig& config,
                               std::span<const NodeId> covariance_of) {
  Input input{sorted_items(nodes, alignments, site), {}, {}, site, config};
  Solution solution;
  for (std::size_t k = 0; k < input.items.alignments.size(); ++k) {
    const Alignment& a = *input.items.alignments[k];
    input.computed_by.push_back(a.computed_by);
    if (initial_status(a, input.items.nodes) != AlignmentStatus::undecided) continue;
    solution.present.push_back(k);
    input.ends.insert(input.ends.end(), {a.i, a.j});
  }
  Placement placement;
  if (input.items.nodes.empty()) {
    placement.outcomes = outcomes(input, solution);
    return placement;
  }
  solve(input, input.items.nodes, solution);
  std::vector<const Node*> solvable, unsolvable;
  if (!solution.rejection.solvable) {
    const std::set<AgentId> agents = unsolvable_agents(input);
    const auto is_unsolvable = [&](const AgentId& agent) { return agents.contains(agent); };
    for (const Node* node : input.items.nodes)
      (is_unsolvable(node->id.agent) ? unsolvable : solvable).push_back(node);
    std::erase_if(solution.present, [&](std::size_t k) {
      const Alignment& a = *input.items.alignments[k];
      return is_unsolvable(a.i.agent) || is_unsolvable(a.j.agent);
    });
    if (!agents.empty()) solve(input, solvable, solution);
  }
  placement.outcomes = outcomes(input, solution);
  placement.contradicting = solution.rejection.contradicting;
  placement.alignment_stats = stats_by_agent(placement.outcomes, solution.rejection);
  placement.used = used_alignments(input, solution.rejection);
  add_poses(solution.graph, solution.rejection.estimate, placement);
  placement.components = components(solution);
  add_unsolvable(input, unsolvable, placement);
  std::ranges::sort(placement.components);
  placement.covariance = covariances(solution, covariance_of);
  return placement;
}

}  // namespace fleetmap::graph
