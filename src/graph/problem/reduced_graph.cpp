#include "problem/reduced_graph.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "fleetmap/geometry/symmetric.hpp"
#include "problem/gps_windows.hpp"

namespace fleetmap::graph {
namespace {

constexpr double kOdometryFloorM = 1e-3;    // m a step: a node's pose is rounded on the wire
constexpr double kOdometryFloorRad = 2e-4;  // rad a step

void add_frame(ReducedGraph& graph, FrameSpan frame, const std::vector<bool>& is_end, const LocalFrame& site,
               const FleetPlacementConfig& config) {
  const std::vector<GpsWindow> windows = gps_windows(graph.nodes, frame, config);
  std::size_t window = 0;
  frame.first_pose = graph.poses.size();
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t k = frame.first; k < frame.end; ++k) {
    const Node& node = *graph.nodes[k];
    if (k > frame.first) {
      const Matrix6d carry = adjoint(node.T_odom_base.inverse() * graph.nodes[k - 1]->T_odom_base);
      covariance = carry * covariance * carry.transpose() + odometry_step(graph, k);
    }
    const bool starts_window = window < windows.size() && windows[window].first == k;
    if (!starts_window && !is_end[k] && k + 1 != frame.end) continue;
    PoseVariable variable;
    variable.node = k;
    variable.frame = graph.frames.size();
    if (starts_window)
      variable = with_window(variable, graph.nodes, windows[window++], windows.size(), site, config);
    if (k > frame.first) {
      const std::size_t a = graph.poses.size() - 1;
      const Node& before = *graph.nodes[graph.poses[a].node];
      graph.odometry.emplace_back(a, a + 1, before.T_odom_base.inverse() * node.T_odom_base, covariance);
    }
    covariance.setZero();
    if (is_end[k]) graph.pose_of[node.id] = graph.poses.size();
    graph.poses.push_back(variable);
  }
  frame.end_pose = graph.poses.size();
  graph.frames.push_back(frame);
}

/// Links the windows of each robot in time. The drift of its GPS continues across its sessions.
void link_drifts(ReducedGraph& graph, const FleetPlacementConfig& config) {
  std::map<AgentId, std::vector<std::size_t>> windows;
  for (std::size_t p = 0; p < graph.poses.size(); ++p) {
    if (graph.poses[p].has_window) windows[graph.nodes[graph.poses[p].node]->id.agent].push_back(p);
  }
  for (auto& [agent, of_agent] : windows) {
    std::ranges::stable_sort(of_agent, {}, [&](std::size_t p) { return graph.poses[p].seconds; });
    for (std::size_t k = 1; k < of_agent.size(); ++k) {
      const std::size_t a = of_agent[k - 1], b = of_agent[k];
      const double seconds = std::max(graph.poses[b].seconds - graph.poses[a].seconds, 0.1);
      graph.drift.push_back({a, b, drift_correlation(graph.poses[a], graph.poses[b], seconds, config)});
    }
  }
}

}  // namespace

BetweenFactor::BetweenFactor(std::size_t from, std::size_t to, const Pose& T_from_to, const Matrix6d& C)
    : a(from), b(to), T_a_b(T_from_to), covariance(C), information(CholeskyOf(C).inverse()) {}

Matrix6d odometry_step(const ReducedGraph& graph, std::size_t k) {
  const Node& node = *graph.nodes[k];
  // Nodes that have not arrived yet are assumed to have the covariance of this one.
  const double steps = static_cast<double>(node.id.seq - graph.nodes[k - 1]->id.seq);
  Matrix6d C = node.odom_covariance;
  C.diagonal().head<3>().array() += kOdometryFloorM * kOdometryFloorM;
  C.diagonal().tail<3>().array() += kOdometryFloorRad * kOdometryFloorRad;
  return std::max(1.0, steps) * C;
}

ReducedGraph reduce(std::span<const Node* const> nodes, std::span<const NodeId> ends, const LocalFrame& site,
                    const FleetPlacementConfig& config) {
  ReducedGraph graph;
  graph.nodes.assign(nodes.begin(), nodes.end());
  const auto by_frame = [](const Node* node) {
    return std::tie(node->id.agent, node->session, node->id.seq);
  };
  if (!std::ranges::is_sorted(graph.nodes, {}, by_frame)) std::ranges::sort(graph.nodes, {}, by_frame);
  const std::set<NodeId> wanted(ends.begin(), ends.end());
  std::vector<bool> is_end(graph.nodes.size());
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) is_end[k] = wanted.contains(graph.nodes[k]->id);
  for (std::size_t first = 0; first < graph.nodes.size();) {
    std::size_t end = first + 1;
    while (end < graph.nodes.size() && graph.nodes[end]->frame() == graph.nodes[first]->frame()) ++end;
    add_frame(graph, {graph.nodes[first]->frame(), first, end, 0, 0}, is_end, site, config);
    first = end;
  }
  link_drifts(graph, config);
  return graph;
}

}  // namespace fleetmap::graph
