#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/drive_silences.hpp"
#include "fleetmap/sensor/gps_agreement.hpp"
#include "fleetmap/sensor/motion_agreement.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::sensor {

/// Finds drivers whose samples decode and are wrong all the same: units other than those of the message
/// definitions, fields that are not filled. Errors whose correction is certain are corrected, samples with
/// others are refused; each is reported once. Clocks are the task of ClockOffsets.
class SensorHealth {
 public:
  /// Correct the sample, or return false: it must not be used.
  bool check(Imu& imu);
  bool check(Wheel& wheel);
  bool check(Fix& fix);
  /// A sample that is held back, since its clock is unclear: its values are not checked, and its sensor is
  /// not silent.
  void hold(const Scan&) { last_scan_.reset(); }
  void hold(const Imu&) { last_imu_.reset(); }
  void hold(const Wheel& wheel) { silences_.add_wheel(wheel.stamp); }
  void hold(const Fix& fix) {
    if (fix.valid) silences_.add_fix(fix.stamp);
  }
  /// base_link in the odometry's frame at a scan, if the scan fitted the map; otherwise empty. Gyro, wheels
  /// and GPS are compared with it.
  void check_motion(Stamp stamp, const std::optional<Pose>& T_odom_base);
  /// Adds the finding of a check that runs elsewhere (TurnDirection), once.
  void add_finding(std::string finding) { state(std::move(finding)); }
  /// Adds a finding by which no sample is wrong, since what it names was corrected exactly.
  void add_note(std::string note);
  /// The reason why gyro and wheels were not compared with the LiDAR; empty if they were.
  std::optional<std::string> motion_not_compared() const { return motion_.not_compared(); }
  /// Mount of the IMU, before its first sample.
  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu);
  /// Takes the angular rates for deg/s from the first one on, for a reason that was found before.
  void expect_degrees(const std::string& why);
  /// Why they are taken for that.
  const std::optional<std::string>& gyro_in_degrees() const { return gyro_in_degrees_; }
  /// True when the wheels' turns, or rates that no robot reaches, decided it.
  bool gyro_unit_decided() const;
  /// A scan, in order. A spinning LiDAR's sweep ends where the next one begins, so scans are missing if they
  /// come more seldom: lost by the network or the system's receive buffer. Without point times the shortest
  /// usual interval of the first scans stands for the sweep, so a loss of every other scan is not noticed.
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
  /// The findings that are notes, and those that are not.
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<std::string> alarms() const;
  /// Gaps of fixes and wheels until now, which are no finding unless they are long.
  std::vector<std::string> gaps() const { return silences_.notes(); }
  /// A fix had its altitude above mean sea level.
  bool heights_above_sea_level() const { return above_sea_level_; }
  /// Samples that check() refused.
  std::uint64_t refused() const { return refused_; }
  /// By the time between scans; an estimate.
  std::uint64_t missing_scans() const { return missing_scans_; }

 private:
  void state_silences() {
    for (std::string& finding : silences_.take_findings()) state(std::move(finding));
  }
  void correct_force(Imu& imu);
  void check_gravity(const Imu& imu);
  void check_gaps(Stamp stamp);
  void count_scan(Duration interval, Duration sweep);
  bool correct_rate(Imu& imu);
  bool correct_twist(Wheel& wheel);
  void state(std::string finding);
  bool refuse();

  std::optional<Wheel> last_wheel_;  ///< as received
  std::optional<std::string> gyro_in_degrees_;
  Stamp impossible_since_;
  double wheel_squares_ = 0.0, products_ = 0.0;  ///< of turn rates, by which gyro and wheels are compared
  std::size_t compared_rates_ = 0;
  std::uint64_t scans_ = 0, missing_scans_ = 0;
  std::size_t reported_ = 0;  ///< findings that take_warnings() gave
  std::uint64_t refused_ = 0;
  std::optional<double> force_scale_;  ///< once the unit is decided, by the median of the first norms
  std::optional<Stamp> last_scan_;
  std::vector<Duration> first_intervals_;   ///< between scans without point times
  std::optional<Duration> usual_interval_;  ///< the shortest of these that is usual
  std::vector<double> first_norms_;
  std::vector<Eigen::Vector3d> first_forces_;  ///< directions in base_link
  Eigen::Quaterniond q_base_imu_ = Eigen::Quaterniond::Identity();
  MotionAgreement motion_;
  GpsAgreement gps_;
  DriveSilences silences_;
  std::optional<Stamp> first_imu_, last_imu_;
  double imu_gaps_ = 0.0;  ///< s
  std::vector<Eigen::Vector3d> grounds_;
  std::uint64_t scans_for_ground_ = 0;
  std::vector<std::string> findings_, notes_;
  int impossible_rates_ = 0;  ///< in a row
  bool speed_from_pose_ = false;
  bool above_sea_level_ = false;
  bool no_altitude_ = false, no_place_ = false, imu_gaps_reported_ = false;
  bool scans_missing_ = false;
};

}  // namespace fleetmap::sensor
