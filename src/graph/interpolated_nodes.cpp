#include "interpolated_nodes.hpp"

#include <algorithm>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::graph {
namespace {

/// A node between pose variables a and b. Its share of the odometry's error between the two is `gain`.
struct InterpolatedNode {
  Pose T_a_node = Pose::Identity();
  Matrix6d P = Matrix6d::Zero();     ///< covariance of T_a_node
  Matrix6d gain = Matrix6d::Zero();  ///< times the error at b
};

/// The nodes between pose variables a and b. The odometry's error between the two is distributed over them in
/// proportion to its covariance, which is the Gaussian conditional mean.
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

}  // namespace

std::vector<Pose> interpolated_poses(const ReducedGraph& graph, const Estimate& estimate) {
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
  return T_enu;
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

}  // namespace fleetmap::graph
