#pragma once

#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

/// Poses for the tools of ROS 2: what goes out and is not read back.
namespace fleetmap::ros_codec {

/// A transform between two named frames at a time.
struct StampedTransform {
  Stamp stamp;
  std::string parent, child;
  Pose T_parent_child = Pose::Identity();
};
/// A tf2_msgs/TFMessage.
Bytes encode(const std::vector<StampedTransform>& transforms);

/// A geometry_msgs/PoseWithCovarianceStamped.
struct PoseMsg {
  Stamp stamp;
  std::string frame;
  Pose T_frame_base = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< [m, rad], both in the axes of `frame`
};
Bytes encode(const PoseMsg& pose);

/// A nav_msgs/Path, stamped with its last pose.
struct PathMsg {
  /// A pose and its stamp.
  struct StampedPose {
    Stamp stamp;
    Pose T_frame_base = Pose::Identity();
  };
  std::string frame;
  std::vector<StampedPose> poses;
};
Bytes encode(const PathMsg& path);

}  // namespace fleetmap::ros_codec
