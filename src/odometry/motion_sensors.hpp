#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "motion_prior.hpp"
#include "rate_history.hpp"

namespace fleetmap::odometry {

/// Scans are missing if the time between two exceeds this, s.
inline constexpr double kScanGap = 0.35;
/// The robot moves above these, m/s and rad/s.
inline constexpr double kMovingSpeed = 0.1, kMovingRate = 0.05;

/// The sweep that a prior is made for.
struct SweepTimes {
  Stamp previous;           ///< reference instant of the sweep before
  Stamp reference;          ///< of this one
  double dt = 0.0;          ///< s between the two
  double half_sweep = 0.0;  ///< s from the reference instant to the sweep's end
};

/// Gyro and wheel odometry, both optional: the motion that they measured, and the gyro's bias.
class MotionSensors {
 public:
  explicit MotionSensors(const LoamConfig& config) : config_(config) {}

  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu) { config_.q_base_imu = q_base_imu; }
  /// False if the sample was dropped: not finite, or out of order.
  bool add(const sensor::Imu& imu);
  bool add(const sensor::Wheel& wheel);

  /// Prior of the sweep's motion, from `previous` with its covariance [d_pose, d_twist] and the samples.
  MotionPrior prior(const MotionState& previous, const Matrix12d& covariance, const SweepTimes& times) const;
  /// Displacement by dead reckoning; empty unless gyro and wheels cover the whole interval.
  std::optional<MotionPrior::MeasuredDisplacement> displacement(Stamp from, Stamp to) const;
  /// True if the samples in the interval show motion. Without samples false.
  bool moving(Stamp from, Stamp to) const;
  /// Steady change of the turn rates during a sweep, rad/s^2.
  std::optional<RateHistory::Trend> turn_acceleration(Stamp reference, double half_sweep) const;
  /// Moves the gyro's bias towards its difference from a rotation that the LiDAR measured, over some seconds.
  void learn_gyro_bias(Stamp from, Stamp to, const Eigen::Matrix3d& R_from_to_lidar);

 private:
  LoamConfig config_;
  RateHistory gyro_;    ///< rad/s in base_link
  RateHistory wheels_;  ///< forward speed (m/s), yaw rate (rad/s), and 1 if the yaw rate was measured
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  int bias_samples_ = 0;
};

}  // namespace fleetmap::odometry
