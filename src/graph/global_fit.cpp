#include "global_fit.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::graph {
namespace {

constexpr int kMaxIterations = 20;
constexpr double kMinStep = 1e-10;

/// Number of nodes of each agent that share one independent GPS error.
std::map<AgentId, double> nodes_per_independent_fix(std::span<const Node> nodes, double correlation_time) {
  struct Span {
    Stamp first, last;
    double count = 0.0;
  };
  std::map<AgentId, Span> spans;
  for (const Node& node : nodes) {
    Span& span = spans.try_emplace(node.id.agent, Span{node.stamp, node.stamp}).first->second;
    span.first = std::min(span.first, node.stamp);
    span.last = std::max(span.last, node.stamp);
    span.count += 1.0;
  }
  std::map<AgentId, double> shared;
  for (const auto& [agent, span] : spans) {
    const double independent = 1.0 + to_seconds(span.last - span.first) / correlation_time;
    shared[agent] = std::max(1.0, span.count / independent);
  }
  return shared;
}

}  // namespace

Pose fit_to_global_poses(std::span<const Node> nodes, std::span<const Pose> T_common_node,
                         const LocalFrame& site, double gps_correlation_time) {
  const auto shared = nodes_per_independent_fix(nodes, gps_correlation_time);
  std::vector<Pose> T_enu_node(nodes.size());
  std::vector<Matrix6d> information(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    T_enu_node[k] = pose_in(site, *nodes[k].G);
    information[k] =
        CholeskyOf(nodes[k].G->covariance * shared.at(nodes[k].id.agent) + 1e-12 * Matrix6d::Identity())
            .inverse();
  }
  Pose T_enu_common = T_enu_node.front() * T_common_node.front().inverse();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    // Error state about the ENU axes, centred on the nodes so that rotation and translation decouple.
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Pose& T : T_common_node) centre += T_enu_common * Eigen::Vector3d(T.translation());
    centre /= static_cast<double>(T_common_node.size());
    Matrix6d H = Matrix6d::Zero();
    Vector6d b = Vector6d::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Pose predicted = T_enu_common * T_common_node[k];
      Vector6d residual;
      residual << T_enu_node[k].translation() - predicted.translation(),
          so3_log(T_enu_node[k].linear() * predicted.linear().transpose());
      Matrix6d J = Matrix6d::Identity();
      J.topRightCorner<3, 3>() = -skew(predicted.translation() - centre);
      H += J.transpose() * information[k] * J;
      b += J.transpose() * information[k] * residual;
    }
    const CholeskyOf normal(H);
    if (!normal.positive_definite()) break;
    const Vector6d step = normal.solve(b);
    const Eigen::Matrix3d R = so3_exp(step.tail<3>());
    T_enu_common =
        make_pose(Eigen::Matrix3d(R * T_enu_common.linear()),
                  Eigen::Vector3d(R * (T_enu_common.translation() - centre) + centre + step.head<3>()));
    if (step.norm() < kMinStep) break;
  }
  return T_enu_common;
}

}  // namespace fleetmap::graph
