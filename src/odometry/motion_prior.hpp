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
  /// rad/s^2 in base_link, constant during the sweep. A robot that sways or pitches over a bump turns by
  /// milliradians more or less within a sweep than its mean velocity predicts.
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

/// Prior of a sweep's motion before its points are used: the last state with its covariance, a velocity that
/// changes as white noise on acceleration (Barfoot, State Estimation for Robotics, 11.2), and optionally gyro
/// and wheels.
class MotionPrior {
 public:
  /// Rotation of base_link from the last reference instant to this one, measured by a gyro.
  struct MeasuredRotation {
    Eigen::Matrix3d R_previous_now;
    double sigma;  ///< rad
  };

  /// Displacement of base_link since the last reference instant, in its frame then, by dead reckoning from
  /// wheels and gyro.
  struct MeasuredDisplacement {
    Eigen::Vector3d p_previous_now;  ///< m
    double sigma;                    ///< m
  };

  /// `covariance` of `previous`, [d_pose, d_twist]; `dt` s since then, > 0. `way` needs a `gyro`.
  MotionPrior(const LoamConfig& config, const MotionState& previous, const Matrix12d& covariance, double dt,
              const std::optional<MeasuredRotation>& gyro = std::nullopt,
              const std::optional<MeasuredDisplacement>& way = std::nullopt);

  /// Mean angular rate of base_link during the sweep, rad/s, bias removed.
  void set_gyro_rate(const Eigen::Vector3d& rate, double sigma);
  /// A gyro anchors the turn rate, so that the map cannot be distorted by more of it than the gyro errs.
  bool has_gyro_rate() const { return has_gyro_rate_; }
  bool has_forward_speed() const { return has_forward_speed_; }
  bool has_yaw_rate() const { return has_yaw_rate_; }
  /// During the sweep, as the gyro saw it, rad/s^2.
  void set_turn_acceleration(const Eigen::Vector3d& acceleration) { turn_acceleration_ = acceleration; }
  void set_forward_speed(double speed, double sigma);
  /// Wheels roll forward: base_link moves sideways by no more than `sigma`, m/s.
  void set_no_sideslip(double sigma);
  void set_yaw_rate(double rate, double sigma);

  /// During the sweep, given the velocity in it, rad/s^2. Without a gyro that of the time between the two
  /// sweeps counts for the half of this sweep that lies in it; of the other half nothing is known.
  Eigen::Vector3d turn_acceleration(const Vector6d& twist) const;
  /// The most likely state given only this prior.
  MotionState predicted() const;
  /// m, 1 sigma of the predicted position in its worst direction.
  double position_sigma() const;
  /// Covariance of the predicted pose: right tangent of T_odom_base, [m, rad].
  Matrix6d pose_covariance() const { return covariance_.topLeftCorner<6, 6>(); }
  NormalEquations linearised(const MotionState& state) const;

 private:
  void measure_rate(int axis, double value, double sigma);

  double dt_;
  Vector6d previous_twist_;
  Eigen::Vector3d turn_known_before_;  ///< share of a change of the turn rates that is no error of the last
  Pose T_odom_base_;
  Vector6d twist_;
  Matrix12d covariance_;  ///< of the two above
  bool has_gyro_rate_ = false, has_forward_speed_ = false, has_yaw_rate_ = false;
  std::optional<Eigen::Vector3d> turn_acceleration_;
};

}  // namespace fleetmap::odometry
