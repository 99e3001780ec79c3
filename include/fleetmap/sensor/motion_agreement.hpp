#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/running_integral.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/turn_lag.hpp"

namespace fleetmap::sensor {

/// Compares the motion that the LiDAR measured with that of gyro and wheels: scales, signs, axes, directions
/// and stamps. Drivers that have one of these wrong decode, and bend a map or break its odometry. The
/// first 10 m and 1.2 rad are judged by themselves; windows after them, by wider bounds, where several in a
/// row contradict. Each contradiction is found once; which sensor is wrong is decided by the majority.
class MotionAgreement {
 public:
  /// IMU frame to base_link; of configuration or /tf_static.
  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu) { q_base_imu_ = q_base_imu; }
  void add(const Imu& imu);
  void add(const Wheel& wheel);
  /// base_link in the odometry's frame at the reference instant of a scan that fitted the map.
  void add_motion(Stamp stamp, const Pose& T_odom_base);
  /// The motion has no relation to the one before: the odometry lost its way or began anew.
  void interrupt();
  /// A sentence on what was not compared yet and how far the robot has to move for it; empty if all was.
  std::optional<std::string> not_compared() const;
  /// Since the last call.
  std::vector<std::string> take_findings();

 private:
  /// Judges the windows of one comparison.
  class Windows {
   public:
    /// True where what was compared since `from` contradicts and that suffices for a finding.
    bool confirm(bool contradicts, Stamp from);
    bool any() const { return count_ > 0; }
    bool found() const { return found_; }
    /// The beginning of those in a row that contradict.
    Stamp since() const { return since_; }

   private:
    std::size_t count_ = 0, in_a_row_ = 0;
    Stamp since_;
    bool found_ = false;
  };
  struct Step {
    Stamp from, to;
    Eigen::Vector2d moved;  ///< m, in the axes of base_link
    double turned;          ///< rad about z
  };
  void compare(const Step& step);
  void compare_drive(const Step& step);
  void compare_turn(const Step& step);
  void compare_gyro_and_wheel_stamps(Stamp imu);
  void check_drive();
  void report_drive(const Eigen::Vector2d& slope, bool first);
  void check_turns();
  void report_turns(const std::optional<Eigen::Vector3d>& gyro, const std::optional<double>& wheels);
  void check_gyro(const Eigen::Vector3d& slope, const std::string& others);
  std::string since(const Windows& windows) const;
  void compare_gyro_and_wheels(Stamp to);
  void report_lag(const TurnLag::Found& found, const std::string& other);

  Eigen::Quaterniond q_base_imu_ = Eigen::Quaterniond::Identity();
  RunningIntegral gyro_;    ///< rad in base_link
  RunningIntegral wheels_;  ///< m forward, rad about z, and s in which the turn rate was measured
  struct Instant {
    Stamp stamp;
    Pose T_odom_base;
  };
  std::optional<Instant> last_;
  std::deque<Step> waiting_;                       ///< until the other sensors have passed them
  double lidar_drove_ = 0.0, lidar_turned_ = 0.0;  ///< m, rad

  // Sums over steps; the LiDAR's squares divide them.
  double driven_ = 0.0, drive_squares_ = 0.0;  // m, m^2
  Eigen::Vector2d drive_products_ = Eigen::Vector2d::Zero();
  double gyro_turned_ = 0.0, gyro_squares_ = 0.0;  // rad, rad^2
  Eigen::Vector3d gyro_products_ = Eigen::Vector3d::Zero();
  double wheel_turned_ = 0.0, wheel_squares_ = 0.0, wheel_products_ = 0.0;
  std::optional<Stamp> compared_to_;                   ///< gyro with wheels
  double wheels_turned_ = 0.0, wheels_squares_ = 0.0;  // rad, rad^2
  Eigen::Vector3d gyro_by_wheels_ = Eigen::Vector3d::Zero();
  Stamp drive_from_, turns_from_;  ///< of the windows under way
  Windows drive_windows_, turn_windows_;
  TurnLag lidar_lag_{TurnLag::Config{}};
  TurnLag wheel_lag_{TurnLag::Config{.same_scale = false, .first_is_usual = true}};
  std::optional<Stamp> stamps_compared_to_;  ///< gyro with wheels
  bool lag_reported_ = false;
  std::vector<std::string> findings_;
};

}  // namespace fleetmap::sensor
