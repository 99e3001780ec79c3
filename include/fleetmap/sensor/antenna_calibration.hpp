#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::sensor {

/// Lever arm of the GPS antenna.
struct AntennaCalibration {
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();  ///< m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();      ///< m^2, along base_link's axes
  Calibrated delay;  ///< s by which the fixes' stamps are later than the LiDAR's
};

/// Compares fixes with the places of an antenna that the LiDAR's track carries, both less their mean over
/// windows of 8 s, so that errors of GPS that are slower than that cancel. Only turns show the lever arm, and
/// only tilting shows its height. `expected` as in calibrate_imu(). Fails without fixes and on drives that
/// are too short or straight.
Result<AntennaCalibration> calibrate_antenna(const CalibrationDrive& drive, const Eigen::Vector3d& expected);

}  // namespace fleetmap::sensor
