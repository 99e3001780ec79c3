#include "fleetmap/ros_codec/poses.hpp"

#include "fleetmap/bus/cdr.hpp"
#include "nav_msgs.h"
#include "ros_geometry.hpp"
#include "tf2_msgs.h"

namespace fleetmap::ros_codec {

Bytes encode(const std::vector<StampedTransform>& transforms) {
  tf2_msgs::msg::dds_::TFMessage_ out;
  for (const StampedTransform& transform : transforms) {
    geometry_msgs::msg::dds_::TransformStamped_& one = out.transforms().emplace_back();
    one.header(header(transform.stamp, transform.parent));
    one.child_frame_id(transform.child);
    one.transform().translation(to_ros(Eigen::Vector3d(transform.T_parent_child.translation())));
    one.transform().rotation(to_ros(Eigen::Quaterniond(transform.T_parent_child.linear())));
  }
  return bus::to_cdr(out);
}

Bytes encode(const PoseMsg& pose) {
  geometry_msgs::msg::dds_::PoseWithCovarianceStamped_ out;
  out.header(header(pose.stamp, pose.frame));
  out.pose().pose(to_ros(pose.T_frame_base));
  out.pose().covariance(to_ros(pose.covariance));
  return bus::to_cdr(out);
}

Bytes encode(const PathMsg& path) {
  nav_msgs::msg::dds_::Path_ out;
  out.header(header(path.poses.empty() ? Stamp{} : path.poses.back().stamp, path.frame));
  for (const PathMsg::StampedPose& pose : path.poses) {
    geometry_msgs::msg::dds_::PoseStamped_& one = out.poses().emplace_back();
    one.header(header(pose.stamp, path.frame));
    one.pose(to_ros(pose.T_frame_base));
  }
  return bus::to_cdr(out);
}

}  // namespace fleetmap::ros_codec
