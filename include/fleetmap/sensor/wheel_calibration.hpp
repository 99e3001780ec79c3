#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::sensor {

/// Mount of the LiDAR by the wheels: its error as a transform of base_link.
struct WheelCalibration {
  /// From base_link as the LiDAR's mount places it to base_link by the wheels, which drives along its x axis,
  /// turns about its z axis, and in turns does not slide sideways at its origin. The height is not measured.
  Pose T_wheels_base = Pose::Identity();
  /// The translation (m) and a small rotation (rad) that precedes it, both along base_link's axes.
  Matrix6d covariance = Matrix6d::Zero();
  Calibrated speed_scale;  ///< speed of the wheels over that of the LiDAR
};

/// Compares the LiDAR's motion over steps of 1 s with arcs of the wheels' length along which it turns as the
/// LiDAR does (as Censi et al., Simultaneous calibration of odometry and sensor parameters, T-RO 2013, for
/// differential drives; here the wheels' turn rate is not used, which skid steering falsifies). Fails without
/// wheels, and on drives that are too short.
Result<WheelCalibration> calibrate_wheels(const CalibrationDrive& drive);

}  // namespace fleetmap::sensor
