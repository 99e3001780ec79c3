#include "problem/valid_items.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace fleetmap::graph {
namespace {

constexpr double kMaxCoordinate = 1e6;  // m; doubles resolve nanometres there

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

const NodeId& id_of(const Node* node) { return node->id; }

bool contains(const std::vector<const Node*>& nodes, const NodeId& id) {
  const auto it = std::ranges::lower_bound(nodes, id, {}, id_of);
  return it != nodes.end() && (*it)->id == id;
}

}  // namespace

SortedItems sorted_items(std::span<const Node> nodes, std::span<const Alignment> alignments,
                         const LocalFrame& site) {
  SortedItems items;
  for (const Node& node : nodes) {
    if (is_valid(node) && site.to_enu(node.G->position).norm() <= kMaxCoordinate)
      items.nodes.push_back(&node);
  }
  if (!std::ranges::is_sorted(items.nodes, {}, id_of)) std::ranges::sort(items.nodes, {}, id_of);
  for (const Alignment& alignment : alignments) items.alignments.push_back(&alignment);
  std::ranges::sort(items.alignments, {},
                    [](const Alignment* a) { return std::tie(a->computed_by, a->seq); });
  return items;
}

AlignmentStatus initial_status(const Alignment& alignment, const std::vector<const Node*>& sorted_nodes) {
  if (!is_valid(alignment)) return AlignmentStatus::invalid;
  const bool complete = contains(sorted_nodes, alignment.i) && contains(sorted_nodes, alignment.j);
  return complete ? AlignmentStatus::undecided : AlignmentStatus::waiting;
}

}  // namespace fleetmap::graph
