#pragma once

#include <cstdint>

#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::sensor {

/// Mounts and errors of a made-up drive, drawn at random, and what its sensors measured.
struct MadeDrive {
  Pose T_base_imu = Pose::Identity();
  double imu_delay = 0.0;  ///< s
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();
  double gps_delay = 0.0;                 ///< s
  Pose T_wheels_base = Pose::Identity();  ///< error of the LiDAR's mount
  double speed_scale = 1.0;
  CalibrationDrive drive;
};

struct MadeDriveOptions {
  double seconds = 120.0;
  double turn_rate = 0.6;  ///< rad/s, in turns to both sides; 0: straight on
  double sway = 0.01;      ///< rad, of roll and pitch
  double gps_white = 0.3;  ///< m, from fix to fix
  double gps_slow = 1.0;   ///< m, over a minute
};

/// A robot drives figures of eight at 0.6 to 1.4 m/s: LiDAR at 10 Hz (5 mm, 0.5 mrad), IMU at 100 Hz with
/// noise and biases of a MEMS, GPS at 5 Hz, wheels at 20 Hz that slip by 2 %. The mount of the IMU is turned
/// by any angle.
MadeDrive made_drive(std::uint64_t seed, const MadeDriveOptions& options = {});

}  // namespace fleetmap::sensor
