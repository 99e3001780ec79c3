#include "fleetmap/loop_closure/submap_drift.hpp"

#include "path_segment.hpp"

namespace fleetmap::loop_closure {
namespace {

/// Covariance of the odometry over a path of which only the ends are available.
Matrix6d usual_covariance(double metres) {
  static const registration::MapDrift usual = registration::MapDrift::straight();
  const Pose step = usual.stops[0].T_cloud_base.inverse() * usual.stops[1].T_cloud_base;
  return metres / step.translation().norm() * usual.stops[1].step_covariance;
}

}  // namespace

registration::MapDrift drift_around(const store::Store& store, const graph::Node& node, double reach) {
  registration::MapDrift drift;
  const graph::Node* previous = nullptr;
  for (const graph::Node* next : path_segment_around(store, node, reach)) {
    registration::MapStop stop{node.T_odom_base.inverse() * next->T_odom_base, next->odom_covariance};
    if (previous != nullptr && previous->id.seq + 1 != next->id.seq) {
      const Pose T_previous_next = previous->T_odom_base.inverse() * next->T_odom_base;
      stop.step_covariance = usual_covariance(T_previous_next.translation().norm());
    }
    drift.stops.push_back(stop);
    previous = next;
  }
  return drift;
}

}  // namespace fleetmap::loop_closure
