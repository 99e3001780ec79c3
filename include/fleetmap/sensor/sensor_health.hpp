#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// Finds drivers whose samples decode and are wrong all the same: units other than those of the message
/// definitions, fields that are not filled. What is certain is corrected, the rest refused; either is said
/// once. Clocks are the task of ClockOffsets.
class SensorHealth {
 public:
  /// Correct the sample, or return false: it must not be used.
  bool check(Imu& imu);
  bool check(Wheel& wheel);
  bool check(const Fix& fix);
  /// A scan with point times, in order. A spinning LiDAR's sweep ends where the next one begins, so scans are
  /// missing if they come more seldom: lost by the network or the system's receive buffer.
  void check_scan(Stamp stamp, Duration sweep);
  /// Counts a scan. True for some, until it is decided how the ground lies: ground_normal() should be found.
  bool ground_due();
  /// The upward normal of the ground in base_link. A robot stands on the ground, so that in the median of
  /// many scans it is base_link's z, on slopes as well; else the LiDAR's mount is wrong.
  void check_ground(const Eigen::Vector3d& normal);

  /// Findings since the last call, each with its remedy.
  std::vector<std::string> take_warnings();
  /// All that was found, in order.
  const std::vector<std::string>& findings() const { return findings_; }
  /// Samples that check() refused.
  std::uint64_t refused() const { return refused_; }
  /// By the time between scans; an estimate.
  std::uint64_t missing_scans() const { return missing_scans_; }

 private:
  void correct_force(Imu& imu);
  bool correct_rate(Imu& imu);
  void state(std::string finding);
  bool refuse();

  std::optional<Wheel> last_wheel_;  ///< as received
  double rate_scale_ = 1.0;
  Stamp impossible_since_;
  double wheel_squares_ = 0.0, products_ = 0.0;  ///< of turn rates, by which gyro and wheels are compared
  std::size_t compared_rates_ = 0;
  std::uint64_t scans_ = 0, missing_scans_ = 0;
  std::size_t reported_ = 0;  ///< findings that take_warnings() gave
  std::uint64_t refused_ = 0;
  std::optional<double> force_scale_;  ///< once the unit is decided, by the median of the first norms
  std::optional<Stamp> last_scan_;
  std::vector<double> first_norms_;
  std::vector<Eigen::Vector3d> grounds_;
  std::uint64_t scans_for_ground_ = 0;
  std::vector<std::string> findings_;
  int impossible_rates_ = 0;  ///< in a row
  bool speed_from_pose_ = false;
  bool no_altitude_ = false;
  bool scans_missing_ = false;
};

}  // namespace fleetmap::sensor
