#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

/// Which way is up in the odometry frame. At one moment the EKF tells it only to a degree or two, since it
/// takes the acceleration of a bend for gravity; but the odometry frame does not turn, so a mean over the
/// last minute tells it far better.
class LevelTrack {
 public:
  /// `up_in_base`: what the EKF tells at `stamp`, where the odometry says T_odom_base.
  void add(const Eigen::Vector3d& up_in_base, const Pose& T_odom_base, Stamp stamp);
  /// In base_link, of length 1.
  Eigen::Vector3d up_in_base(const Pose& T_odom_base) const;

 private:
  std::optional<Eigen::Vector3d> up_in_odom_;
  Stamp first_, last_;
};

/// `G` with its tilt, but not its heading, turned such that `up_in_base` is up.
GlobalPose levelled(const GlobalPose& G, const Eigen::Vector3d& up_in_base);

}  // namespace fleetmap::agent
