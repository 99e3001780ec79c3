#pragma once

#include <vector>

#include "problem/estimate.hpp"
#include "solver/graph_solver.hpp"

namespace fleetmap::graph {

/// T_enu_node of all nodes of the graph. Nodes between two pose variables follow from these and the odometry.
std::vector<Pose> interpolated_poses(const ReducedGraph& graph, const Estimate& estimate);

/// Marginal covariance of the k-th node, right tangent of T_enu_node: [m, rad].
Matrix6d covariance_of_node(const ReducedGraph& graph, const GraphSolver& solver, std::size_t k);

}  // namespace fleetmap::graph
