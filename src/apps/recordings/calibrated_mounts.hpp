#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::apps {

/// Mounts of a robot's sensors in base_link.
struct SensorPlaces {
  Pose T_base_lidar = Pose::Identity();
  Pose T_base_imu = Pose::Identity();
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();  ///< m
};

/// A number that a drive may show.
struct CalibratedQuantity {
  std::string sensor;  ///< as sentences name it
  std::string name;
  std::string unit;             ///< deg, m, ms or none
  sensor::Calibrated estimate;  ///< in `unit`
  double in_use = 0.0;          ///< the number that the settings or /tf_static have
  bool observable = false;      ///< else the estimate is of no use
  std::string remedy = {};      ///< the drive that shows it, where it is not observable

  /// They differ by more than three sigmas.
  bool differs() const;
};

/// One sensor's mount with its covariance.
struct CalibratedPlace {
  std::string section;  ///< of the configuration
  bool with_rotation = true;
  Pose T_base_sensor = Pose::Identity();  ///< as in use where it was not observable
  Eigen::MatrixXd covariance;  ///< m, and rad of a small rotation that precedes, along base_link's axes
  std::string kept;            ///< names of what is as in use, comma-separated; may be empty
};

struct CalibratedMounts {
  double metres = 0.0, turned = 0.0;  ///< m and rad that the robot drove and turned
  std::vector<CalibratedQuantity> quantities;
  std::vector<CalibratedPlace> places;
  std::vector<std::string> skipped;  ///< a sentence on each sensor without an estimate
};

/// All mounts that `drive` shows, whose base_link is that of the LiDAR's mount in use. With wheels, the
/// LiDAR's mount is corrected by them, and the others move with it.
CalibratedMounts calibrate_mounts(const sensor::CalibrationDrive& drive, const SensorPlaces& in_use);

}  // namespace fleetmap::apps
