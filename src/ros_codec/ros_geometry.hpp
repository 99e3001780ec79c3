#pragma once

#include <array>
#include <string>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "geometry_msgs.h"
#include "ros_time.hpp"
#include "std_msgs.h"

namespace fleetmap::ros_codec {

inline geometry_msgs::msg::dds_::Vector3_ to_ros(const Eigen::Vector3d& v) {
  geometry_msgs::msg::dds_::Vector3_ out;
  out.x(v.x());
  out.y(v.y());
  out.z(v.z());
  return out;
}

inline geometry_msgs::msg::dds_::Point_ point_to_ros(const Eigen::Vector3d& p) {
  geometry_msgs::msg::dds_::Point_ out;
  out.x(p.x());
  out.y(p.y());
  out.z(p.z());
  return out;
}

inline geometry_msgs::msg::dds_::Quaternion_ to_ros(const Eigen::Quaterniond& q) {
  geometry_msgs::msg::dds_::Quaternion_ out;
  out.x(q.x());
  out.y(q.y());
  out.z(q.z());
  out.w(q.w());
  return out;
}

inline geometry_msgs::msg::dds_::Pose_ to_ros(const Pose& T) {
  geometry_msgs::msg::dds_::Pose_ out;
  out.position(point_to_ros(T.translation()));
  out.orientation(to_ros(Eigen::Quaterniond(T.linear())));
  return out;
}

/// Row-major.
inline std::array<double, 36> to_ros(const Matrix6d& covariance) {
  std::array<double, 36> out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = covariance(static_cast<int>(k) / 6, static_cast<int>(k) % 6);
  return out;
}

inline Matrix6d covariance_from_ros(const std::array<double, 36>& in) {
  Matrix6d out;
  for (std::size_t k = 0; k < in.size(); ++k) out(static_cast<int>(k) / 6, static_cast<int>(k) % 6) = in[k];
  return out;
}

inline std_msgs::msg::dds_::Header_ header(Stamp stamp, const std::string& frame) {
  std_msgs::msg::dds_::Header_ out;
  out.stamp(to_ros(stamp));
  out.frame_id(frame);
  return out;
}

inline Eigen::Vector3d from_ros(const geometry_msgs::msg::dds_::Vector3_& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond from_ros(const geometry_msgs::msg::dds_::Quaternion_& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace fleetmap::ros_codec
