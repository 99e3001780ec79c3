#pragma once

#include <array>
#include <optional>
#include <string>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/running_integral.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::sensor {

/// Compares scans with one another, without an odometry, which such a LiDAR makes lose its way in the first
/// turn: whether the scene turns as gyro and wheels turn, or the other way. It is decided once, over the
/// first radian; later scans cost nothing.
class TurnDirection {
 public:
  /// Mounts of LiDAR and IMU.
  TurnDirection(const Eigen::Matrix3d& R_base_lidar, const Eigen::Quaterniond& q_base_imu)
      : R_base_lidar_(R_base_lidar.cast<float>()), q_base_imu_(q_base_imu) {}

  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu) { q_base_imu_ = q_base_imu; }
  void add(const Imu& imu);
  void add(const Wheel& wheel);
  /// Once gyro and wheels have passed its stamp.
  void add(const Scan& scan);
  bool decided() const { return decided_; }
  /// A sentence with the cause and its remedy, if it is decided that the scans turn against the gyro.
  std::optional<std::string> finding() const;

 private:
  static constexpr std::size_t kBins = 360;
  using Ranges = std::array<float, kBins>;  ///< m, to the nearest upright thing by azimuth; 0: nothing

  Ranges ranges_of(const Scan& scan) const;
  void compare(const Ranges& now, double turned);

  Eigen::Matrix3f R_base_lidar_;
  Eigen::Quaterniond q_base_imu_;
  RunningIntegral gyro_, wheels_;  ///< rad
  struct Reference {
    Stamp stamp;
    Ranges ranges;
  };
  std::optional<Reference> reference_;
  bool decided_ = false;
  int compared_ = 0;          ///< scans
  double turned_ = 0.0;       ///< rad, by the gyro
  double with_wheels_ = 0.0;  ///< rad^2, products of both
  /// Misfits of scans turned with the gyro, against it and not at all.
  double along_ = 0.0, against_ = 0.0, unturned_ = 0.0;
};

}  // namespace fleetmap::sensor
