#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/loam_config.hpp"

namespace fleetmap::odometry {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Pose of base_link at a sweep's reference instant and its velocity during the sweep.
struct MotionState {
  Pose T_odom_base = Pose::Identity();
  Vector6d twist = Vector6d::Zero();  ///< in base_link, [m/s, rad/s], constant during the sweep
};

/// Normal equations H dx = -g for dx = [d_pose, d_twist] with T <- T exp(d_pose), twist <- twist + d_twist.
struct NormalEquations {
  Matrix12d H = Matrix12d::Zero();
  Vector12d g = Vector12d::Zero();
};

/// What is known of a sweep's motion before its points are looked at: the last state, and that velocity
/// changes as white noise on acceleration (Barfoot, State Estimation for Robotics, 11.2); optionally gyro and
/// wheels.
class MotionPrior {
 public:
  /// `dt` s since `previous`, > 0; `twist_variance` of the components of previous.twist, (m/s)^2 and
  /// (rad/s)^2.
  MotionPrior(const LoamConfig& config, const MotionState& previous, const Vector6d& twist_variance,
              double dt);

  /// Mean angular rate of base_link during the sweep, rad/s, bias removed.
  void set_gyro_rate(const Eigen::Vector3d& rate, double sigma);
  /// Rotation of base_link from the last reference instant to this one; sigma in rad.
  void set_gyro_rotation(const Eigen::Matrix3d& R_previous_now, double sigma);
  void set_forward_speed(double speed, double sigma);
  void set_yaw_rate(double rate, double sigma);

  /// The most likely state given only this prior.
  MotionState predicted() const;
  NormalEquations linearised(const MotionState& state) const;

 private:
  void replace_rate(int axis, double value, double sigma);
  Vector6d mean_twist(const Vector6d& now) const;

  MotionState previous_;
  double dt_;
  Vector6d twist_mean_, twist_information_;
  Vector6d smoothing_;         ///< share of a correction of the velocity now that holds for the one before
  Vector6d pose_information_;  ///< of the pose, given the velocity now
  std::optional<Eigen::Matrix3d> R_previous_now_;
  double rotation_information_ = 0.0;
};

}  // namespace fleetmap::odometry
