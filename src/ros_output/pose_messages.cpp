#include "fleetmap/ros_output/pose_messages.hpp"

#include "fleetmap/geometry/rotated_covariance.hpp"

namespace fleetmap::ros_output {
std::optional<MapPose> map_pose(const graph::PoseNow& pose, const std::optional<GeoPoint>& origin) {
  if (pose.placed) {
    return MapPose{pose.placed->origin, pose.placed->T_enu_odom, pose.placed->T_enu_odom * pose.T_odom_base,
                   pose.placed->covariance, pose.placed->georeferenced};
  }
  if (!pose.G || !origin) return std::nullopt;
  const LocalFrame map(*origin);
  const Pose T_map_base = pose_in(map, *pose.G);
  return MapPose{*origin, T_map_base * pose.T_odom_base.inverse(), T_map_base,
                 rotated(pose.G->covariance, map.R_enu_local(pose.G->position)), true};
}

std::vector<ros_codec::StampedTransform> transforms(const graph::PoseNow& pose,
                                                    const std::optional<MapPose>& on_map) {
  std::vector<ros_codec::StampedTransform> all{{pose.stamp, kOdomFrame, kBaseFrame, pose.T_odom_base}};
  if (on_map) all.push_back({pose.stamp, kMapFrame, kOdomFrame, on_map->T_map_odom});
  return all;
}

ros_codec::PoseMsg pose_message(const graph::PoseNow& pose, const MapPose& on_map) {
  return {pose.stamp, kMapFrame, on_map.T_map_base, on_map.covariance};
}

std::optional<sensor::Fix> fused_fix(const graph::PoseNow& pose, const std::optional<MapPose>& on_map) {
  sensor::Fix fix;
  fix.stamp = pose.stamp;
  if (on_map && on_map->georeferenced) {
    const LocalFrame map(on_map->origin);
    fix.position = map.to_geo(on_map->T_map_base.translation());
    const Eigen::Matrix3d R_local_map = map.R_enu_local(fix.position).transpose();
    fix.covariance = R_local_map * on_map->covariance.topLeftCorner<3, 3>() * R_local_map.transpose();
    return fix;
  }
  if (!pose.G) return std::nullopt;
  fix.position = pose.G->position;
  fix.covariance = pose.G->covariance.topLeftCorner<3, 3>();
  return fix;
}

}  // namespace fleetmap::ros_output
