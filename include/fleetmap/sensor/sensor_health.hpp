#pragma once

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

  /// What was found since the last call, each with its remedy.
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

  // Specific force: the unit is decided by the median of the first norms.
  std::vector<double> first_norms_;
  std::optional<double> force_scale_;
  // Angular rate.
  double rate_scale_ = 1.0;
  int impossible_rates_ = 0;  ///< in a row
  Stamp impossible_since_;
  double wheel_squares_ = 0.0, products_ = 0.0;
  std::size_t compared_rates_ = 0;
  std::optional<Wheel> last_wheel_;  ///< as received
  bool speed_from_pose_ = false;
  bool no_altitude_ = false;
  std::optional<Stamp> last_scan_;
  std::uint64_t scans_ = 0, missing_scans_ = 0;
  bool scans_missing_ = false;
  std::vector<std::string> findings_;
  std::size_t told_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace fleetmap::sensor
