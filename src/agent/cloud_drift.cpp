#include "fleetmap/agent/cloud_drift.hpp"

#include <limits>
#include <optional>

namespace fleetmap::agent {
namespace {

/// Of the odometry over a way of which nothing is known but its ends.
Matrix6d usual_covariance(double metres) {
  static const registration::MapDrift usual = registration::MapDrift::straight();
  const Pose step = usual.stops[0].T_cloud_base.inverse() * usual.stops[1].T_cloud_base;
  return metres / step.translation().norm() * usual.stops[1].step_covariance;
}

}  // namespace

registration::MapDrift drift_around(const store::Store& store, const graph::Node& node, double radius) {
  registration::MapDrift drift;
  Matrix6d since_stop = Matrix6d::Zero();
  const graph::Node* previous = nullptr;
  for (const graph::Node* next :
       store.nodes_from({node.id.agent, 0, std::numeric_limits<std::uint32_t>::max()})) {
    if (next->frame() != node.frame()) continue;
    if (previous != nullptr) {
      const Pose T_next_previous = next->T_odom_base.inverse() * previous->T_odom_base;
      // What was uncertain before is seen from the next node's base_link.
      const Matrix6d Ad = adjoint(T_next_previous);
      const bool neighbours = previous->id.seq + 1 == next->id.seq;
      since_stop =
          Ad * since_stop * Ad.transpose() +
          (neighbours ? next->odom_covariance : usual_covariance(T_next_previous.translation().norm()));
    }
    previous = next;
    const Pose T_node_next = node.T_odom_base.inverse() * next->T_odom_base;
    if (T_node_next.translation().norm() > radius) continue;
    drift.stops.push_back({T_node_next, since_stop});
    since_stop.setZero();
  }
  return drift;
}

}  // namespace fleetmap::agent
