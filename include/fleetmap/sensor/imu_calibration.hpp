#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::sensor {

/// Mount of the IMU, and what had to be estimated with it.
struct ImuCalibration {
  Pose T_base_imu = Pose::Identity();
  /// The translation (m) and a small rotation (rad) that precedes it, both along base_link's axes.
  Matrix6d covariance = Matrix6d::Zero();
  Calibrated delay;  ///< s by which the IMU's stamps are later than the LiDAR's
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< rad/s in the IMU's frame
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< m/s^2 in the IMU's frame
};

/// Hand-eye calibration of LiDAR and IMU on one drive. The turns of both give the rotation but for what the
/// turn axis leaves free; the specific force, integrated over windows of 2 s and compared with the change of
/// the LiDAR's mean velocity, gives that and the lever arm (continuous-time estimates of the same: Furgale,
/// Rehder and Siegwart, IROS 2013; LI-Init, Zhu, Ren and Zhang, IROS 2022, initialises alike). Gravity's
/// direction, biases and the delay are estimated with them. `expected`: the mount that is configured, which
/// only a parameter that the drive does not excite keeps. Fails on drives without an IMU, and on those that
/// are too short or too straight.
Result<ImuCalibration> calibrate_imu(const CalibrationDrive& drive, const Pose& expected);

}  // namespace fleetmap::sensor
