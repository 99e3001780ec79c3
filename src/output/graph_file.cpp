#include "fleetmap/output/graph_file.hpp"

#include <Eigen/Cholesky>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

namespace fleetmap::output {
namespace {

void write_g2o_pose(std::ostream& out, const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  out << ' ' << T.translation().x() << ' ' << T.translation().y() << ' ' << T.translation().z() << ' '
      << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
}

/// Inverse of the covariance of a right tangent [m, rad]; g2o's error is translation and vector part of a
/// quaternion, which is half the rotation. Empty for what is no covariance.
std::optional<Matrix6d> information_of(const Matrix6d& covariance) {
  const Eigen::LLT<Matrix6d> factor(covariance);
  if (factor.info() != Eigen::Success || !covariance.allFinite()) return std::nullopt;
  Eigen::Matrix<double, 6, 1> scale;
  scale << 1.0, 1.0, 1.0, 2.0, 2.0, 2.0;
  return scale.asDiagonal() * factor.solve(Matrix6d::Identity()) * scale.asDiagonal();
}

void write_edge(std::ostream& out, std::size_t i, std::size_t j, const Pose& T_i_j,
                const Matrix6d& covariance) {
  const auto information = information_of(covariance);
  if (!information) return;
  out << "EDGE_SE3:QUAT " << i << ' ' << j;
  write_g2o_pose(out, T_i_j);
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = row; column < 6; ++column) out << ' ' << (*information)(row, column);
  }
  out << '\n';
}

}  // namespace

GraphText to_g2o(const std::vector<graph::Node>& nodes, const graph::Placement& placement) {
  std::ostringstream out, names;
  out << std::setprecision(12);
  names << "vertex,node,stamp_ns\n";
  std::map<NodeId, std::size_t> vertices;
  for (const graph::Node& node : nodes) {
    const auto placed = placement.T_enu_node.find(node.id);
    if (placed == placement.T_enu_node.end()) continue;
    const std::size_t vertex = vertices.size();
    vertices.emplace(node.id, vertex);
    names << vertex << ',' << to_string(node.id) << ',' << to_ns(node.stamp) << '\n';
    out << "VERTEX_SE3:QUAT " << vertex;
    write_g2o_pose(out, placed->second);
    out << '\n';
  }
  std::map<graph::FrameId, const graph::Node*> last;
  for (const graph::Node& node : nodes) {
    const graph::Node*& previous = last[node.frame()];
    if (previous != nullptr && vertices.contains(previous->id) && vertices.contains(node.id)) {
      write_edge(out, vertices.at(previous->id), vertices.at(node.id),
                 previous->T_odom_base.inverse() * node.T_odom_base,
                 // Nodes between that have not arrived are assumed to have the covariance of this one.
                 static_cast<double>(node.id.seq - previous->id.seq) * node.odom_covariance);
    }
    previous = &node;
  }
  for (const graph::Alignment& alignment : placement.used) {
    if (!vertices.contains(alignment.i) || !vertices.contains(alignment.j)) continue;
    write_edge(out, vertices.at(alignment.i), vertices.at(alignment.j), alignment.best().T_i_j,
               alignment.best().covariance);
  }
  return {out.str(), names.str()};
}

}  // namespace fleetmap::output
