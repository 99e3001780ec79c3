#include "fleetmap/graph/fleet_placement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <tuple>

#include "fleetmap/geometry/symmetric.hpp"
#include "problem/reduced_graph.hpp"
#include "rejection/alignment_selection.hpp"
#include "rejection/innovation.hpp"
#include "solver/graph_solver.hpp"

namespace fleetmap::graph {
namespace {

/// Mistakes with one other agent count up to this: its clouds may be at fault.
constexpr std::size_t kMistakesPerOther = 2;
constexpr std::size_t kMistakesToQuarantine = 4;
constexpr std::size_t kMistakesPerUsed = 2;
constexpr int kMaxQuarantineRounds = 3;

constexpr std::size_t kMaxPosesOfRigidFit = 40;

constexpr double kMaxCoordinate = 1e6;  // of any coordinate; keeps the numbers apart from their rounding

bool is_pose(const Pose& T) {
  return all_finite(T) && T.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate &&
         (T.linear() * T.linear().transpose()).isIdentity(1e-6);
}

bool is_covariance(const Matrix6d& C) {
  return C.allFinite() && C.cwiseAbs().maxCoeff() <= 1e12 && C.isApprox(C.transpose(), 1e-9) &&
         (C.diagonal().array() >= 0.0).all() &&
         // But for rounding, positive semidefinite.
         Matrix6d(C + 1e-12 * C.cwiseAbs().maxCoeff() * Matrix6d::Identity()).ldlt().isPositive();
}

bool is_valid(const Node& node) {
  return node.G && fleetmap::is_valid(node.G->position) && std::abs(node.G->position.altitude) <= 1e5 &&
         std::abs(node.G->q_enu_base.norm() - 1.0) < 1e-3 && node.G->covariance.diagonal().allFinite() &&
         (node.G->covariance.diagonal().array() >= 0.0).all() && is_pose(node.T_odom_base) &&
         is_covariance(node.odom_covariance);
}

bool is_valid(const AlignmentMode& mode) { return is_pose(mode.T_i_j) && is_covariance(mode.covariance); }

bool is_valid(const Alignment& a) {
  return a.i != a.j && !a.modes.empty() && a.modes.size() <= Alignment::kMaxModes &&
         std::ranges::all_of(a.modes, [](const AlignmentMode& mode) { return is_valid(mode); });
}

/// The items as they take part: valid, sorted by name.
struct Items {
  std::vector<const Node*> nodes;
  std::vector<const Alignment*> alignments;
  std::vector<AgentId> computed_by;  ///< by alignment
  std::vector<AlignmentOutcome> outcomes;
};

Items sorted_items(std::span<const Node> nodes, std::span<const Alignment> alignments,
                   const LocalFrame& site) {
  Items items;
  for (const Node& node : nodes) {
    if (is_valid(node) && site.to_enu(node.G->position).norm() <= kMaxCoordinate)
      items.nodes.push_back(&node);
  }
  const auto by_id = [](const Node* node) -> const NodeId& { return node->id; };
  if (!std::ranges::is_sorted(items.nodes, {}, by_id)) std::ranges::sort(items.nodes, {}, by_id);
  for (const Alignment& alignment : alignments) items.alignments.push_back(&alignment);
  std::ranges::sort(items.alignments, {},
                    [](const Alignment* a) { return std::tie(a->computed_by, a->seq); });
  for (const Alignment* a : items.alignments) {
    items.computed_by.push_back(a->computed_by);
    items.outcomes.push_back({a->i, a->j, a->computed_by, a->seq, AlignmentStatus::undecided, 0});
  }
  return items;
}

bool holds(const std::vector<const Node*>& nodes, const NodeId& id) {
  const auto it =
      std::ranges::lower_bound(nodes, id, {}, [](const Node* node) -> const NodeId& { return node->id; });
  return it != nodes.end() && (*it)->id == id;
}

/// Alignments that may take part now; the others are judged.
std::vector<std::size_t> present(Items& items) {
  std::vector<std::size_t> present;
  for (std::size_t k = 0; k < items.alignments.size(); ++k) {
    const Alignment& a = *items.alignments[k];
    if (!is_valid(a)) {
      items.outcomes[k].status = AlignmentStatus::invalid;
    } else if (!holds(items.nodes, a.i) || !holds(items.nodes, a.j)) {
      items.outcomes[k].status = AlignmentStatus::waiting;
    } else {
      present.push_back(k);
    }
  }
  return present;
}

/// An alternative that leaves the place open by more than what tells rows apart fits wherever the others do.
bool is_sharp(const AlignmentMode& mode) {
  return mode.covariance.diagonal().head<3>().maxCoeff() < kCertainM * kCertainM;
}

std::vector<Candidate> candidates_of(const Items& items, const std::vector<std::size_t>& present,
                                     const ReducedGraph& graph, const FleetPlacementConfig& config) {
  std::vector<Candidate> candidates;
  for (const std::size_t k : present) {
    const Alignment& a = *items.alignments[k];
    const std::size_t i = graph.pose_of.at(a.i), j = graph.pose_of.at(a.j);
    const std::size_t frame_i = graph.poses[i].frame, frame_j = graph.poses[j].frame;
    const bool any_sharp = std::ranges::any_of(a.modes, is_sharp);
    for (std::size_t m = 0; m < a.modes.size(); ++m) {
      if (any_sharp && !is_sharp(a.modes[m])) continue;
      Candidate candidate;
      candidate.alignment = k;
      candidate.mode = m;
      candidate.modes = a.modes.size();
      Vector6d floor;
      floor << Eigen::Vector3d::Constant(config.alignment_floor_m),
          Eigen::Vector3d::Constant(config.alignment_floor_rad);
      const Matrix6d C = a.modes[m].covariance + Matrix6d(floor.cwiseAbs2().asDiagonal());
      candidate.between = BetweenFactor(i, j, a.modes[m].T_i_j, C);
      candidate.frames = std::minmax(frame_i, frame_j);
      candidate.sign = std::pair(frame_i, i) < std::pair(frame_j, j) ? 1.0 : -1.0;
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

/// Each frame as a rigid whole where its fixes say.
Estimate rigid_frames(const ReducedGraph& graph, const LocalFrame& site, const FleetPlacementConfig& config) {
  Estimate estimate;
  estimate.drift.assign(graph.poses.size(), Eigen::Vector3d::Zero());
  for (const FrameSpan& frame : graph.frames) {
    std::vector<Node> nodes;
    std::vector<Pose> T_odom_node;
    const std::size_t stride = 1 + (frame.end_pose - frame.first_pose) / kMaxPosesOfRigidFit;
    for (std::size_t p = frame.first_pose; p < frame.end_pose; p += stride) {
      nodes.push_back(*graph.nodes[graph.poses[p].node]);
      // Nobody knows better than a kilometre; keeps the equations solvable.
      Eigen::Matrix<double, 6, 1> variance = nodes.back().G->covariance.diagonal().cwiseMin(1e6);
      nodes.back().G->covariance = variance.cwiseMax(1e-9).asDiagonal();
      T_odom_node.push_back(nodes.back().T_odom_base);
    }
    const Pose T_enu_odom = fit_to_global_poses(nodes, T_odom_node, site, config.gps_correlation_time);
    for (std::size_t p = frame.first_pose; p < frame.end_pose; ++p)
      estimate.T_enu.push_back(T_enu_odom * graph.nodes[graph.poses[p].node]->T_odom_base);
  }
  return estimate;
}

// ---- nodes between poses

/// A node between poses a and b: what part of the odometry's error up to b it has.
struct InterpolatedNode {
  Pose T_a_node = Pose::Identity();
  Matrix6d P = Matrix6d::Zero();     ///< covariance of T_a_node
  Matrix6d gain = Matrix6d::Zero();  ///< of the error at b
};

/// The nodes after variable a, up to and without variable b; the odometry's error between the two is spread
/// over them as its covariance says.
std::vector<InterpolatedNode> nodes_between(const ReducedGraph& graph, std::size_t a, std::size_t b) {
  std::vector<InterpolatedNode> nodes;
  const Node& first = *graph.nodes[graph.poses[a].node];
  const std::size_t end = graph.poses[b].node;
  Matrix6d P = Matrix6d::Zero();
  for (std::size_t k = graph.poses[a].node + 1; k <= end; ++k) {
    const Node& node = *graph.nodes[k];
    const Matrix6d carry = adjoint(node.T_odom_base.inverse() * graph.nodes[k - 1]->T_odom_base);
    P = carry * P * carry.transpose() + odometry_step(graph, k);
    nodes.push_back({first.T_odom_base.inverse() * node.T_odom_base, P, Matrix6d::Zero()});
  }
  const Pose T_a_b = nodes.back().T_a_node;
  const Matrix6d P_b_inverse = CholeskyOf(nodes.back().P).inverse();
  nodes.pop_back();
  for (InterpolatedNode& node : nodes) {
    const Matrix6d carry = adjoint(T_a_b.inverse() * node.T_a_node);
    node.gain = node.P * carry.transpose() * P_b_inverse;
  }
  return nodes;
}

void place_nodes(const ReducedGraph& graph, const Estimate& estimate, Placement& placement) {
  std::vector<Pose> T_enu(graph.nodes.size());
  for (std::size_t p = 0; p < graph.poses.size(); ++p) T_enu[graph.poses[p].node] = estimate.T_enu[p];
  for (const BetweenFactor& step : graph.odometry) {
    std::size_t k = graph.poses[step.a].node;
    if (k + 1 == graph.poses[step.b].node) continue;
    const Vector6d error =
        se3_log(step.T_a_b.inverse() * estimate.T_enu[step.a].inverse() * estimate.T_enu[step.b]);
    for (const InterpolatedNode& node : nodes_between(graph, step.a, step.b))
      T_enu[++k] = estimate.T_enu[step.a] * node.T_a_node * se3_exp(node.gain * error);
  }
  auto& placed = placement.T_enu_node;
  for (std::size_t k = 0; k < T_enu.size(); ++k)
    placed.insert_or_assign(placed.end(), graph.nodes[k]->id, T_enu[k]);
  for (const FrameSpan& frame : graph.frames) {
    const Node& newest = *graph.nodes[frame.end - 1];
    placement.T_enu_odom[frame.id] = estimate.T_enu[frame.end_pose - 1] * newest.T_odom_base.inverse();
  }
}

Matrix6d covariance_of_node(const ReducedGraph& graph, const GraphSolver& solver, std::size_t k) {
  const auto after = std::ranges::upper_bound(graph.poses, k, {}, &PoseVariable::node);
  const auto a = static_cast<std::size_t>(after - graph.poses.begin()) - 1;
  if (graph.poses[a].node == k) {
    const auto z = solver.sensitivity(a);
    return BlockCholesky::inner(z, z);
  }
  const std::size_t b = a + 1;
  const std::vector<InterpolatedNode> between = nodes_between(graph, a, b);
  const InterpolatedNode& node = between[k - graph.poses[a].node - 1];
  const Pose T_a_b =
      graph.nodes[graph.poses[a].node]->T_odom_base.inverse() * graph.nodes[graph.poses[b].node]->T_odom_base;
  const Matrix6d H_a = adjoint(node.T_a_node.inverse()) - node.gain * adjoint(T_a_b.inverse());
  const auto z = solver.sensitivity(a, b, H_a, node.gain);
  const Matrix6d carry = adjoint(T_a_b.inverse() * node.T_a_node);
  const Matrix6d rest = node.P - node.gain * carry * node.P;
  return BlockCholesky::inner(z, z) + 0.5 * (rest + rest.transpose());
}

void add_covariances(const ReducedGraph& graph, const GraphSolver& solver, std::span<const NodeId> wanted,
                     Placement& placement) {
  if (wanted.empty()) return;
  const std::set<NodeId> ids(wanted.begin(), wanted.end());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
    const NodeId& id = graph.nodes[k]->id;
    if (ids.contains(id)) placement.covariance[id] = covariance_of_node(graph, solver, k);
  }
}

// ---- agents

/// What was solved together.
struct Solution {
  ReducedGraph graph;
  Estimate estimate;
  std::vector<Candidate> candidates;
  Selection selection;
};

/// Agents that compute false alignments.
std::set<AgentId> faulty(const Selection& selection, const Items& items,
                         std::map<AgentId, AgentCredit>& credits) {
  std::map<AgentId, std::size_t> used;
  for (const auto& [alignment, candidate] : selection.taken) ++used[items.computed_by[alignment]];
  std::set<AgentId> found;
  for (const auto& [agent, by_other] : selection.mistakes) {
    std::size_t mistakes = 0;
    for (const auto& [other, count] : by_other) mistakes += std::min(count, kMistakesPerOther);
    credits[agent].outlier_sets = mistakes;
    if (mistakes >= kMistakesToQuarantine && mistakes >= kMistakesPerUsed * used[agent]) found.insert(agent);
  }
  return found;
}

/// Solves, and anew without the alignments of agents that turn out to be faulty.
void solve(Items& items, std::vector<std::size_t>& taking_part, std::span<const NodeId> ends,
           const LocalFrame& site, const FleetPlacementConfig& config,
           std::map<AgentId, AgentCredit>& credits, Solution& solution) {
  solution.graph = reduce(items.nodes, ends, site, config);
  const Estimate rigid = rigid_frames(solution.graph, site, config);
  for (int attempt = 0;; ++attempt) {
    solution.candidates = candidates_of(items, taking_part, solution.graph, config);
    solution.estimate = rigid;
    solution.selection =
        select_alignments(solution.graph, solution.candidates, items.computed_by, solution.estimate);
    const std::set<AgentId> found = faulty(solution.selection, items, credits);
    if (found.empty() || attempt == kMaxQuarantineRounds) return;
    for (const AgentId& agent : found) credits[agent].quarantined = true;
    std::erase_if(taking_part, [&](std::size_t k) {
      if (!found.contains(items.computed_by[k])) return false;
      items.outcomes[k].status = AlignmentStatus::quarantined;
      return true;
    });
  }
}

/// Agents whose own GPS and odometry cannot be solved: finite numbers that are absurd together.
std::set<AgentId> unsolvable(std::span<const Node* const> nodes, std::span<const NodeId> ends,
                             const LocalFrame& site, const FleetPlacementConfig& config) {
  std::set<AgentId> found;
  for (std::size_t first = 0, end = 0; first < nodes.size(); first = end) {
    const AgentId& agent = nodes[first]->id.agent;
    while (end < nodes.size() && nodes[end]->id.agent == agent) ++end;
    const ReducedGraph graph = reduce(nodes.subspan(first, end - first), ends, site, config);
    Estimate estimate = rigid_frames(graph, site, config);
    if (GraphSolver(graph, {}).solve(estimate, kMaxSteps) != GraphSolver::Outcome::converged)
      found.insert(agent);
  }
  return found;
}

/// Takes their nodes out of the items, and what they are aligned with stays undecided. Returns the nodes.
std::vector<const Node*> set_aside(Items& items, std::vector<std::size_t>& taking_part,
                                   const std::set<AgentId>& agents) {
  std::vector<const Node*> aside;
  std::ranges::copy_if(items.nodes, std::back_inserter(aside),
                       [&](const Node* node) { return agents.contains(node->id.agent); });
  std::erase_if(items.nodes, [&](const Node* node) { return agents.contains(node->id.agent); });
  std::erase_if(taking_part, [&](std::size_t k) {
    return agents.contains(items.alignments[k]->i.agent) || agents.contains(items.alignments[k]->j.agent);
  });
  return aside;
}

void report(const Solution& solution, Items& items, Placement& placement) {
  const auto& [graph, estimate, candidates, selection] = solution;
  for (const auto& [alignment, status] : selection.judged) items.outcomes[alignment].status = status;
  for (const auto& [alignment, candidate] : selection.taken) {
    items.outcomes[alignment].status = AlignmentStatus::used;
    items.outcomes[alignment].mode = candidates[candidate].mode;
    placement.used.push_back(*items.alignments[alignment]);
    placement.used.back().modes = {items.alignments[alignment]->modes[candidates[candidate].mode]};
  }
  for (const AlignmentOutcome& one : items.outcomes) {
    AgentCredit& credit = placement.credits[one.computed_by];
    credit.used += one.status == AlignmentStatus::used;
    credit.rejected +=
        one.status == AlignmentStatus::against_gps || one.status == AlignmentStatus::against_others;
  }
  placement.outcomes = items.outcomes;
}

void add_components(const Solution& solution, Placement& placement) {
  const auto& [graph, estimate, candidates, selection] = solution;
  std::vector<std::size_t> group(graph.frames.size());
  std::iota(group.begin(), group.end(), 0u);
  for (const auto& [alignment, candidate] : selection.taken) {
    const auto [a, b] = candidates[candidate].frames;
    const std::size_t from = std::max(group[a], group[b]), to = std::min(group[a], group[b]);
    std::ranges::replace(group, from, to);
  }
  std::map<std::size_t, std::vector<FrameId>> members;
  for (std::size_t f = 0; f < group.size(); ++f) members[group[f]].push_back(graph.frames[f].id);
  for (const auto& [root, frames] : members) placement.components.push_back(frames);
}

}  // namespace

const char* to_string(AlignmentStatus status) {
  switch (status) {
    case AlignmentStatus::used:
      return "used";
    case AlignmentStatus::against_gps:
      return "against GPS";
    case AlignmentStatus::against_others:
      return "against others";
    case AlignmentStatus::undecided:
      return "undecided";
    case AlignmentStatus::quarantined:
      return "quarantined";
    case AlignmentStatus::waiting:
      return "waiting";
    case AlignmentStatus::invalid:
      return "invalid";
  }
  return "";
}

Status FleetPlacementConfig::validate() const {
  if (!(gps_correlation_time > 0.0)) return failure("fleet.gps_correlation_time must be positive");
  if (!(gps_drift_share > 0.0 && gps_drift_share < 1.0)) {
    return failure("fleet.gps_drift_share must lie between 0 and 1");
  }
  if (!(window_m > 0.0)) return failure("fleet.window_m must be positive");
  if (!(alignment_floor_m > 0.0) || !(alignment_floor_rad > 0.0)) {
    return failure("fleet.alignment_floor_m and alignment_floor_rad must be positive");
  }
  return {};
}

Placement place_by_fleet_graph(std::span<const Node> nodes, std::span<const Alignment> alignments,
                               const LocalFrame& site, const FleetPlacementConfig& config,
                               std::span<const NodeId> covariance_of) {
  Placement placement;
  Items items = sorted_items(nodes, alignments, site);
  std::vector<std::size_t> taking_part = present(items);
  if (items.nodes.empty()) {
    placement.outcomes = items.outcomes;
    return placement;
  }
  std::vector<NodeId> ends;
  for (const std::size_t k : taking_part) {
    ends.push_back(items.alignments[k]->i);
    ends.push_back(items.alignments[k]->j);
  }
  Solution solution;
  solve(items, taking_part, ends, site, config, placement.credits, solution);
  std::vector<const Node*> aside;
  if (!solution.selection.solvable) {
    aside = set_aside(items, taking_part, unsolvable(items.nodes, ends, site, config));
    if (!aside.empty()) solve(items, taking_part, ends, site, config, placement.credits, solution);
  }
  report(solution, items, placement);
  place_nodes(solution.graph, solution.estimate, placement);
  add_components(solution, placement);
  if (!aside.empty()) {
    const ReducedGraph alone =
        reduce(std::span<const Node* const>(aside), std::span<const NodeId>(), site, config);
    place_nodes(alone, rigid_frames(alone, site, config), placement);
    for (const FrameSpan& frame : alone.frames) placement.components.push_back({frame.id});
  }
  std::ranges::sort(placement.components);
  if (solution.selection.solver)
    add_covariances(solution.graph, *solution.selection.solver, covariance_of, placement);
  return placement;
}

}  // namespace fleetmap::graph
