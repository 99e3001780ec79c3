#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::localization {

/// Mounts of the sensors on the robot.
struct Mounting {
  Pose T_base_imu = Pose::Identity();
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();  ///< m, GPS antenna (lever arm)
};

/// Defaults fit a MEMS IMU of some tens of euros.
struct ImuModel {
  double gyro_noise = 2e-3;        ///< rad/s/sqrt(Hz)
  double accel_noise = 2e-2;       ///< m/s^2/sqrt(Hz)
  double gyro_bias_sigma = 1e-2;   ///< rad/s, at start
  double accel_bias_sigma = 0.15;  ///< m/s^2, at start
  double gyro_bias_walk = 5e-5;    ///< rad/s/sqrt(s)
  double accel_bias_walk = 5e-4;   ///< m/s^2/sqrt(s)
  double gravity = 9.80665;        ///< m/s^2; local deviations (0.03) end in the accelerometer bias
  double max_gap = 0.35;           ///< s between samples beyond which they are not integrated
  /// Take the initial heading from the IMU's reported orientation where that agrees with gravity.
  bool use_orientation = true;
  double orientation_tilt_tolerance = 0.17;  ///< rad between reported vertical and measured gravity
  double orientation_yaw_sigma = 0.2;        ///< rad, when the device reports no variance
  double orientation_yaw_floor = 0.05;       ///< rad, lower bound of the sigma of a reported heading
};

/// Errors of GPS: white noise and a first-order Gauss-Markov process (Brown and Hwang, "Introduction to
/// Random Signals and Applied Kalman Filtering"), and the gates against outliers.
struct GpsModel {
  /// s. Errors of GPS are mostly slow (atmosphere, multipath): averaging a thousand fixes of one minute does
  /// not divide their error by thirty. The share `correlated_share` of the reported variance is estimated as
  /// a first-order Gauss-Markov error with this correlation time. 0 takes fixes as independent.
  double correlation_time = 60.0;
  double correlated_share = 0.8;   ///< of the variance, [0, 1)
  double default_sigma_h = 3.0;    ///< m, per axis, where the reported covariance is zero, NaN or not one
  double default_sigma_v = 6.0;    ///< m
  double sigma_floor = 0.01;       ///< m, along any axis
  double sigma_ceiling = 1000.0;   ///< m, along any axis
  double gate = 16.27;             ///< on the squared Mahalanobis distance, 3 degrees of freedom (99.9 %)
  double max_speed = 40.0;         ///< m/s between fixes, beyond which one of them is implausible
  double max_site_radius = 100e3;  ///< m from the origin of the site
  int initial_fixes = 3;           ///< consecutive fixes that must agree before the first is accepted
  double recovery_time = 10.0;  ///< s of rejected fixes that agree with one another until they are accepted
  double recovery_time_far = 60.0;  ///< s, the same for fixes outside max_site_radius (no configured origin)
};

/// Errors of wheel odometry in base_link, with non-holonomic constraints (Dissanayake et al. 2001).
struct WheelModel {
  double speed_sigma = 0.05;     ///< m/s
  double speed_scale = 0.02;     ///< 1, of the speed (tyres, slip)
  double yaw_rate_sigma = 0.05;  ///< rad/s
  double lateral_sigma = 0.1;    ///< m/s, non-holonomic constraint
  double vertical_sigma = 0.1;   ///< m/s, non-holonomic constraint
  double turn_offset = 0.3;      ///< m from base_link to the point that does not slide sideways in turns
  double correlation_time =
      1.0;               ///< s over which these errors persist: faster samples do not add information
  double timeout = 0.5;  ///< s after which a sample is too old to be used for prediction
  double gate = 21.1;    ///< on the squared Mahalanobis distance; beyond, samples weigh less (slip)
};

/// Motion model where no sensor measures the motion.
struct MotionModel {
  double accel_noise = 1.0;             ///< m/s^2/sqrt(Hz), speed changes without an IMU
  double yaw_noise = 0.3;               ///< rad/sqrt(s), turning without IMU and yaw rate
  double yaw_noise_with_wheels = 0.03;  ///< rad/sqrt(s), turning without IMU but with a yaw rate
  double tilt_sigma = 0.1;              ///< rad, slopes of the ground without an IMU
  double tilt_time = 5.0;               ///< s over which such slopes persist
  double speed_sigma = 3.0;             ///< m/s, unknown speed
  double heading_sigma = 0.2;  ///< rad, sigma of a heading from motion that suffices to start with it
};

/// Configuration of the EKF; see the parts for units.
struct EkfConfig {
  Mounting mounting;
  ImuModel imu;
  GpsModel gps;
  WheelModel wheel;
  MotionModel motion;
  std::optional<GeoPoint> site_origin;  ///< origin of the ENU frame; else the first accepted fix
  double history = 8.0;            ///< s of past poses that pose_at() can answer for; scans may wait so long
  double max_lateness = 0.5;       ///< s that a sample may be older than the newest of any sensor, <= history
  double max_extrapolation = 0.3;  ///< s that pose_at() may predict
  double max_time_jump = 10.0;     ///< s forward that need a second sample to confirm them

  /// The name of the field and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::localization
