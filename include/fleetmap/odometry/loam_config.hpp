#pragma once

#include <Eigen/Geometry>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::odometry {

/// Everything that can be set of the odometry. The defaults fit ground robots and cars, VLP-16 to HDL-64E.
struct LoamConfig {
  // Sensor.
  double max_range = 40.0;               ///< m, L_max of the paper: farther returns are dropped
  double min_range = 0.7;                ///< m, nearer returns are the robot itself
  Pose T_base_lidar = Pose::Identity();  ///< LiDAR frame to base_link
  double range_noise = 0.03;             ///< m, 1 sigma of one return

  // Features.
  double feature_half_width = 0.3;    ///< m of surface looked at on either side of a point
  double plane_max_deviation = 0.05;  ///< m, off the chord of its ring: flatter is a plane point
  double match_spacing = 0.4;         ///< m, one plane point per cube of this size is matched
  double insert_spacing = 0.2;        ///< m, one plane point per cube of this size enters the map

  // Local map.
  double fine_resolution = 0.5;    ///< m, step of the map's finer windows (each twice as wide)
  double coarse_resolution = 1.5;  ///< m, step of the coarser windows, for sparse places and large errors
  double coarse_noise = 0.1;       ///< m, 1 sigma of the surfaces within a coarser window
  double map_radius = 60.0;        ///< m around the robot; what lies farther is forgotten
  /// Windows of the map's grids, about 120 bytes each: a full map forgets what lies farthest. A VLP-16 needs
  /// 250,000 and an HDL-64E that is used up to 80 m 411,000. Scans that are laid where they do not belong
  /// would fill all space, 7 million windows within 60 m.
  int max_map_windows = 450'000;
  double keyframe_distance = 0.3;  ///< m, a scan enters the map after this motion ...
  double keyframe_angle = 0.1;     ///< ... or this turn, rad

  // Motion: velocity changes as white noise on acceleration.
  double linear_acceleration = 1.5;   ///< m/s^2, 1 sigma over 0.1 s
  double angular_acceleration = 3.0;  ///< rad/s^2, 1 sigma over 0.1 s
  double initial_speed = 10.0;        ///< m/s, 1 sigma at the first scan
  double initial_turn_rate = 1.0;     ///< rad/s, 1 sigma at the first scan
  bool deskew = true;                 ///< compensate the motion during a scan

  /// 1 sigma of the velocity by which the map itself may be distorted within every sweep: a map of sweeps
  /// that are all distorted alike agrees with the next one distorted alike. The motion from sweep to sweep
  /// constrains it far better, and so does a gyro for the turn rate, with which the second value is not used.
  double map_distortion_speed = 0.3;       ///< m/s
  double map_distortion_turn_rate = 0.15;  ///< rad/s

  // Optional priors; used whenever samples arrive.
  Eigen::Quaterniond q_base_imu = Eigen::Quaterniond::Identity();  ///< rotation, IMU frame to base_link
  double gyro_noise = 0.01;        ///< rad/s, 1 sigma of the mean rate over a scan, bias removed
  double wheel_speed_noise = 0.1;  ///< m/s, 1 sigma at standstill; 5 % of the speed are added
  double wheel_yaw_noise = 0.1;    ///< rad/s, 1 sigma

  // Matching.
  int max_iterations = 12;
  double edge_noise = 0.03;            ///< m, 1 sigma of an edge point about its edge
  double min_inlier_fraction = 0.3;    ///< of the matched points; below it a scan counts as lost
  int min_matches = 60;                ///< fewer matched points count as lost
  int lost_scans_before_restart = 10;  ///< so many lost scans in a row start a new local map

  // Uncertainty.
  /// Information of a scan is divided by this: neighbouring points err together (map, calibration,
  /// incidence). It weighs the scan against the motion and the sensors, and is in every covariance.
  double information_deflation = 2.0;
  // Drift over a metre driven or a radian turned; grows with the root of the way.
  double drift_share = 0.4;          ///< of the variance of a pose in the map
  double drift_translation = 0.001;  ///< m, 1 sigma
  double drift_rotation = 7.0e-5;    ///< rad, 1 sigma

  /// Fails with the field's name and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::odometry
