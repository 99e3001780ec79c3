#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::sensor {

/// Inertial sample in the IMU's frame.
struct Imu {
  Stamp stamp;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< m/s^2, +9.81 on z at rest and level
  /// Rotation from the IMU frame to ENU when the device reports one (REP-145), else empty.
  std::optional<Eigen::Quaterniond> q_enu_imu;
  /// Variance of that orientation about ENU axes, rad^2; 0 when unknown.
  Eigen::Vector3d orientation_variance = Eigen::Vector3d::Zero();
};

/// GPS fix of the antenna.
struct Fix {
  Stamp stamp;
  GeoPoint position;
  bool valid = true;             ///< the receiver reports a fix
  bool above_sea_level = false;  ///< the altitude is above mean sea level instead of the ellipsoid
  /// ENU, m^2, as reported: may be zero, NaN or absurd; the EKF checks it.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Wheel odometry: velocity of base_link in base_link.
struct Wheel {
  Stamp stamp;
  double forward_speed = 0.0;      ///< m/s
  std::optional<double> yaw_rate;  ///< rad/s, when the source measures it
  /// That the source states beside; used by SensorHealth alone.
  std::optional<Pose> T_odom_base = std::nullopt;
};

/// State of the battery.
struct Battery {
  Stamp stamp;
  double share = 1.0;  ///< left, [0, 1]
};

}  // namespace fleetmap::sensor
