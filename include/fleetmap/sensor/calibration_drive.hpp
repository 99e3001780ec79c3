#pragma once

#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// base_link at a scan, in the odometry's frame, by LiDAR alone.
struct LidarPose {
  Stamp stamp;
  Pose T_odom_base;
};

/// A drive whose sensors' mounts are estimated, each list in order of stamps. base_link is where the mount of
/// the LiDAR that the odometry used places it, so that all other mounts are estimated against the LiDAR.
struct CalibrationDrive {
  std::vector<LidarPose> track;
  std::vector<Imu> imu;
  std::vector<Fix> fixes;
  std::vector<Wheel> wheels;
};

/// An estimated number.
struct Calibrated {
  double value = 0.0, sigma = 0.0;
};

/// Sigmas beyond which a number is of no use: the drive did not excite it.
inline constexpr double kMaxRotationSigma = 0.035;  ///< rad
inline constexpr double kMaxLeverSigma = 0.15;      ///< m
inline constexpr double kMaxDelaySigma = 0.02;      ///< s

}  // namespace fleetmap::sensor
