#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

/// The direction against gravity in the odometry frame, by a Kalman filter over blocks of some seconds.
///
/// A single attitude of the EKF is off by a degree or two, since the EKF takes the acceleration of a bend for
/// gravity. The odometry frame itself hardly tilts, so averages over a minute are far better. The remaining
/// error is an offset that is constant in base_link (mount of the IMU, bias of its accelerometer); it turns
/// with the robot and so becomes observable as soon as the heading changes. States: the tilt of the odometry
/// frame, a slow random walk, and that offset. The noise of a block is estimated from the innovations (Mehra,
/// "On the identification of variances and adaptive Kalman filtering", IEEE TAC 1970).
class GravityFilter {
 public:
  /// `up_in_base`: against gravity by the EKF at `stamp`, where the odometry has T_odom_base.
  void add(const Eigen::Vector3d& up_in_base, const Pose& T_odom_base, Stamp stamp);
  /// In base_link, of length 1.
  Eigen::Vector3d up_in_base(const Pose& T_odom_base) const;
  /// rad^2 of each horizontal axis, stated such that values a minute apart count as independent; empty before
  /// the first block.
  std::optional<double> variance() const;

 private:
  struct Block {
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
    Eigen::Matrix2d R_odom_base = Eigen::Matrix2d::Zero();
    int samples = 0;
    Stamp first, last;
  };
  void update(const Block& block);

  Block block_;                                      ///< the one under way
  std::optional<Stamp> updated_;                     ///< end of the last block
  Eigen::Vector4d x_ = Eigen::Vector4d::Zero();      ///< tilt of the odometry frame; offset in base_link
  Eigen::Matrix4d P_ = Eigen::Matrix4d::Identity();  ///< covariance of x_
  double block_variance_ = 0.0;                      ///< rad^2, of a block's mean
  int blocks_ = 0;
};

/// `G` with its tilt, but not its heading, turned such that `up_in_base` is up. The variance of its tilt
/// becomes `variance` (rad^2), if there is one.
GlobalPose levelled(const GlobalPose& G, const Eigen::Vector3d& up_in_base,
                    const std::optional<double>& variance = std::nullopt);

}  // namespace fleetmap::agent
