#include "problem/initial_estimate.hpp"

#include "global_fit.hpp"

namespace fleetmap::graph {
namespace {

constexpr std::size_t kMaxPosesOfRigidFit = 40;

}  // namespace

Estimate initial_estimate(const ReducedGraph& graph, const LocalFrame& site,
                          const FleetPlacementConfig& config) {
  Estimate estimate;
  estimate.drift.assign(graph.poses.size(), Eigen::Vector3d::Zero());
  for (const FrameSpan& frame : graph.frames) {
    std::vector<Node> nodes;
    std::vector<Pose> T_odom_node;
    const std::size_t stride = 1 + (frame.end_pose - frame.first_pose) / kMaxPosesOfRigidFit;
    for (std::size_t p = frame.first_pose; p < frame.end_pose; p += stride) {
      nodes.push_back(*graph.nodes[graph.poses[p].node]);
      // Bounds keep the equations solvable.
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

}  // namespace fleetmap::graph
