#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// Integrals of the rates and specific forces over an interval, in the IMU's frame at its begin (after
/// Forster et al., On-manifold preintegration, T-RO 2017). Both are linear in the accelerometer's bias.
struct InertialMotion {
  double seconds = 0.0;
  Eigen::Matrix3d R_begin_end = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s, of the force alone
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, the same
  Eigen::Matrix3d velocity_by_bias = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d displacement_by_bias = Eigen::Matrix3d::Zero();

  /// `then` begins at the end of this one.
  InertialMotion followed_by(const InertialMotion& then) const;
};

/// Between two instants of the IMU's clock. Empty if samples do not cover them, or have a gap of more than
/// 0.25 s. `imu` is in order of stamps.
std::optional<InertialMotion> integrate(const std::vector<Imu>& imu, Stamp begin, Stamp end,
                                        const Eigen::Vector3d& gyro_bias);

}  // namespace fleetmap::sensor
