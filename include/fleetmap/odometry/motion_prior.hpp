#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/loam_config.hpp"

namespace fleetmap::odometry {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Pose and velocity of base_link at a sweep's reference instant.
struct MotionState {
  Pose T_odom_base = Pose::Identity();
  Vector6d twist = Vector6d::Zero();  ///< in base_link, [m/s, rad/s]
  /// rad/s^2 in base_link, steady during the sweep. A robot that sways or pitches over a bump turns by
  /// milliradians more or less within a sweep than its mean velocity says.
  Eigen::Vector3d turn_acceleration = Eigen::Vector3d::Zero();

  /// T_reference_then: base_link `seconds` after the reference instant.
  Pose motion_to(double seconds) const {
    Vector6d way = seconds * twist;
    way.tail<3>() += 0.5 * seconds * seconds * turn_acceleration;
    return se3_exp(way);
  }
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
  /// During the sweep, as the gyro saw it, rad/s^2.
  void set_turn_acceleration(const Eigen::Vector3d& acceleration) { turn_acceleration_ = acceleration; }
  void set_forward_speed(double speed, double sigma);
  void set_yaw_rate(double rate, double sigma);

  /// During the sweep, given the velocity in it, rad/s^2. Without a gyro that of the time between the two
  /// sweeps counts for the half of this sweep that lies in it; of the other half nothing is known.
  Eigen::Vector3d turn_acceleration(const Vector6d& twist) const;
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
  std::optional<Eigen::Vector3d> turn_acceleration_;
  double rotation_information_ = 0.0;
};

}  // namespace fleetmap::odometry
