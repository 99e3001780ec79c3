#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::sensor {

/// One transform as a driver or a robot's description published it, unchecked.
struct FrameTransform {
  std::string parent, child;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m, of the child's origin in the parent
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// The rigid transforms between a robot's frames, as tf2 has them. A leading slash of a name is ignored.
class FrameTree {
 public:
  /// Replaces an earlier transform of the same child. Refuses one that is not finite or whose quaternion is
  /// not of length 1; the error names both frames.
  Status add(const FrameTransform& transform);
  bool empty() const { return by_child_.empty(); }
  bool has_parent(const std::string& frame) const { return by_child_.contains(name_of(frame)); }
  /// Without the leading slash.
  static std::string name_of(const std::string& frame);
  /// T_base_frame by way of the common root of both. The error names the frames that do not connect, or those
  /// that form a cycle.
  Result<Pose> find(const std::string& base, const std::string& frame) const;

 private:
  struct Parent {
    std::string name;
    Pose T_parent_child;
  };
  struct Root {
    std::string name;
    Pose T_root_frame;
  };
  Result<Root> root_of(const std::string& frame) const;

  std::map<std::string, Parent> by_child_;
};

/// The frames that a robot's messages name.
struct SensorFrames {
  FrameTree tree;  ///< of /tf_static
  std::array<std::string, 4>
      ids;  ///< frame_id of LiDAR, IMU, GPS and wheels; empty: not heard, or not filled
  std::vector<std::string> refused;  ///< transforms that FrameTree::add refused

  void add(const std::vector<FrameTransform>& transforms);
};

}  // namespace fleetmap::sensor
