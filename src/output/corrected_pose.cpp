#include "corrected_pose.hpp"

#include <algorithm>

namespace fleetmap::output {
namespace {

Pose carried_by(const CorrectedNode& node, const Pose& T_odom_base) {
  return node.T_enu_base * node.T_odom_base.inverse() * T_odom_base;
}

}  // namespace

Pose corrected_pose(std::span<const CorrectedNode> nodes, const Pose& T_enu_odom,
                    const StampedPose& odometry) {
  if (nodes.empty()) return T_enu_odom * odometry.T_w_base;
  const auto after = std::ranges::upper_bound(nodes, odometry.stamp, {}, &CorrectedNode::stamp);
  if (after == nodes.begin()) return carried_by(nodes.front(), odometry.T_w_base);
  if (after == nodes.end()) return carried_by(nodes.back(), odometry.T_w_base);
  const CorrectedNode& before = *std::prev(after);
  const double share = to_seconds(odometry.stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(carried_by(before, odometry.T_w_base), carried_by(*after, odometry.T_w_base), share);
}

}  // namespace fleetmap::output
