#include "fleetmap/sensor/motion_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "short_number.hpp"

namespace fleetmap::sensor {
namespace {

constexpr Duration kLongestStep = std::chrono::milliseconds(700);
constexpr std::size_t kMaxMotionsWaiting = 50;
// A step that counts: the LiDAR's noise is a tenth of it.
constexpr double kMinMove = 0.03, kMinTurn = 0.01;                // m, rad
constexpr double kCheckedAfter = 10.0, kTurnsCheckedAfter = 1.2;  // m, rad
// Tyres, slip and skid steering explain less.
constexpr double kSpeedScale = 1.25, kLidarYaw = 15.0 * kDegree;
constexpr double kGyroScale = 1.4, kWheelTurnScale = 3.0;
constexpr double kOtherAxis = 0.6;               // of the turn, on an axis that is not z
constexpr double kWheelTurnsCheckedAfter = 2.0;  // rad
constexpr Duration kWheelStep = std::chrono::milliseconds(150);
constexpr double kNothing = 0.2;  // of the motion
// Windows after the first: slip, mud and turns on the spot last for some metres.
constexpr std::size_t kWindowsInARow = 3;
constexpr double kCheckedAgainAfter = 5.0;  // m
constexpr double kLaterSpeedScale = 1.5, kLaterLidarYaw = 30.0 * kDegree;
constexpr double kLaterGyroScale = 2.0, kLaterWheelTurnScale = 4.0;
constexpr Duration kIntegralsKept = std::chrono::seconds(2);

bool agrees(double slope, double scale) { return slope > 1.0 / scale && slope < scale; }

const char* wheel_unit_of(double scale) {
  if (std::abs(scale - 3.6) < 0.4) return ": its unit seems to be km/h and not m/s";
  if (std::abs(scale - 2.24) < 0.15) return ": its unit seems to be miles per hour and not m/s";
  if (scale > 500.0 && scale < 1500.0) return ": its unit seems to be mm/s and not m/s";
  return ": the diameter of the wheels, the gear or the unit is wrong";
}

}  // namespace

bool MotionAgreement::Windows::confirm(bool contradicts, Stamp from) {
  const bool first = count_++ == 0;
  if (!contradicts) in_a_row_ = 0;
  if (!contradicts || found_) return false;
  if (++in_a_row_ == 1) since_ = from;
  found_ = first || in_a_row_ >= kWindowsInARow;
  return found_;
}

std::string MotionAgreement::since(const Windows& windows) const {
  return " since " + to_utc(windows.since());
}

void MotionAgreement::add(const Imu& imu) {
  gyro_.add(imu.stamp, q_base_imu_ * imu.angular_velocity);
  // The one that comes later has both.
  if (wheels_.last() && *wheels_.last() <= imu.stamp) compare_gyro_and_wheels(*wheels_.last());
  compare_gyro_and_wheel_stamps(imu.stamp);
}

void MotionAgreement::add(const Wheel& wheel) {
  wheels_.add(wheel.stamp, {wheel.forward_speed, wheel.yaw_rate.value_or(0.0), wheel.yaw_rate ? 1.0 : 0.0});
}

void MotionAgreement::interrupt() { last_.reset(); }

void MotionAgreement::add_motion(Stamp stamp, const Pose& T_odom_base) {
  const std::optional<Instant> before = std::exchange(last_, Instant{stamp, T_odom_base});
  if (before && stamp > before->stamp && stamp - before->stamp < kLongestStep) {
    const Pose T_before_now = before->T_odom_base.inverse() * T_odom_base;
    waiting_.push_back(
        {before->stamp, stamp, T_before_now.translation().head<2>(), so3_log(T_before_now.linear()).z()});
  }
  const auto passed = [](const RunningIntegral& sensor, Stamp at) {
    return !sensor.last() || *sensor.last() >= at;
  };
  const Duration reach = TurnLag::reach();
  while (!waiting_.empty() &&
         ((passed(gyro_, waiting_.front().to + reach) && passed(wheels_, waiting_.front().to)) ||
          waiting_.size() > kMaxMotionsWaiting)) {
    compare(waiting_.front());
    waiting_.pop_front();
  }
}

void MotionAgreement::compare(const Step& step) {
  if (step.moved.norm() >= kMinMove) lidar_drove_ += step.moved.norm();
  if (std::abs(step.turned) >= kMinTurn) lidar_turned_ += std::abs(step.turned);
  compare_drive(step);
  compare_turn(step);
  lidar_lag_.add(gyro_, step.from, step.to, step.turned);
  if (const auto found = lidar_lag_.take_found()) report_lag(*found, "the LiDAR");
}

void MotionAgreement::compare_drive(const Step& step) {
  const auto wheels = wheels_.between(step.from, step.to);
  if (drive_windows_.found() || !wheels || step.moved.norm() < kMinMove) return;
  if (driven_ == 0.0) drive_from_ = step.from;
  driven_ += step.moved.norm();
  drive_squares_ += step.moved.squaredNorm();
  drive_products_ += wheels->x() * step.moved;
  if (driven_ > (drive_windows_.any() ? kCheckedAgainAfter : kCheckedAfter)) check_drive();
}

void MotionAgreement::check_drive() {
  const Eigen::Vector2d slope = drive_products_ / drive_squares_;
  const bool first = !drive_windows_.any();
  const double yaw = std::abs(std::atan2(slope.y(), slope.x()));
  const bool contradicts = yaw > (first ? kLidarYaw : kLaterLidarYaw) ||
                           !agrees(slope.norm(), first ? kSpeedScale : kLaterSpeedScale);
  if (drive_windows_.confirm(contradicts, drive_from_)) report_drive(slope, first);
  driven_ = drive_squares_ = 0.0;
  drive_products_.setZero();
}

void MotionAgreement::report_drive(const Eigen::Vector2d& slope, bool first) {
  const double scale = slope.norm();
  const std::string since =
      first ? " over the first " + short_number(driven_) + " m" : this->since(drive_windows_);
  if (scale < kNothing) {
    findings_.push_back("wheel odometry: it stands while the LiDAR moves" + since +
                        ": the twist is not filled, or the topic is dead. Correct the driver, or set "
                        "odometry.use_wheel: false");
    return;
  }
  const double yaw = std::atan2(slope.y(), slope.x());
  if (std::abs(yaw) > std::numbers::pi - kLidarYaw) {
    findings_.push_back("wheel odometry: it drives backwards while the LiDAR moves forwards" + since +
                        ": the sign of twist.linear.x is wrong, or the LiDAR is turned by 180 deg and "
                        "lidar.rotation_rpy_deg does not say so");
  } else if (std::abs(yaw) > kLidarYaw) {
    findings_.push_back("LiDAR: it moves " + short_number(std::abs(yaw) / kDegree) + " deg to the " +
                        (yaw > 0.0 ? "left" : "right") + " of where the wheels drive" + since +
                        ": lidar.rotation_rpy_deg should have " + short_number(-yaw / kDegree) +
                        " deg more yaw");
  }
  if (!agrees(scale, kSpeedScale)) {
    findings_.push_back("wheel odometry: it is " + short_number(scale) + " times as fast as the LiDAR" +
                        since + wheel_unit_of(scale) +
                        ", or the LiDAR's points are not in metres. Correct the driver");
  }
}

void MotionAgreement::compare_turn(const Step& step) {
  if (turn_windows_.found() || std::abs(step.turned) < kMinTurn) return;
  if (gyro_turned_ == 0.0 && wheel_turned_ == 0.0) turns_from_ = step.from;
  if (const auto gyro = gyro_.between(step.from, step.to)) {
    gyro_turned_ += std::abs(step.turned);
    gyro_squares_ += step.turned * step.turned;
    gyro_products_ += step.turned * *gyro;
  }
  const auto wheels = wheels_.between(step.from, step.to);
  if (wheels && wheels->z() > 0.99 * to_seconds(step.to - step.from)) {
    wheel_turned_ += std::abs(step.turned);
    wheel_squares_ += step.turned * step.turned;
    wheel_products_ += step.turned * wheels->y();
  }
  if (std::max(gyro_turned_, wheel_turned_) > kTurnsCheckedAfter) check_turns();
}

void MotionAgreement::check_turns() {
  std::optional<Eigen::Vector3d> gyro;
  std::optional<double> wheels;
  if (gyro_turned_ > 0.5 * kTurnsCheckedAfter) gyro = gyro_products_ / gyro_squares_;
  if (wheel_turned_ > 0.5 * kTurnsCheckedAfter) wheels = wheel_products_ / wheel_squares_;
  const bool first = !turn_windows_.any();
  const bool contradicts = (gyro && !agrees(gyro->z(), first ? kGyroScale : kLaterGyroScale)) ||
                           (wheels && !agrees(*wheels, first ? kWheelTurnScale : kLaterWheelTurnScale));
  if (turn_windows_.confirm(contradicts, turns_from_)) {
    const std::size_t before = findings_.size();
    report_turns(gyro, wheels);
    for (std::size_t k = before; k < findings_.size() && !first; ++k)
      findings_[k] += ". It does so" + since(turn_windows_);
  }
  gyro_turned_ = gyro_squares_ = wheel_turned_ = wheel_squares_ = wheel_products_ = 0.0;
  gyro_products_.setZero();
}

void MotionAgreement::report_turns(const std::optional<Eigen::Vector3d>& gyro,
                                   const std::optional<double>& wheels) {
  if (gyro && wheels && gyro->z() < -kNothing && *wheels < -kNothing) {
    findings_.emplace_back(
        "LiDAR: it turns right where gyro and wheels turn left: its points are mirrored (left-handed axes, "
        "or a device that turns the other way), or it is mounted upside down and lidar.rotation_rpy_deg does "
        "not say so");
    return;
  }
  if (wheels && !agrees(*wheels, kWheelTurnScale)) {
    const std::string how = *wheels < -kNothing ? "the sign of twist.angular.z is wrong"
                            : *wheels < kNothing
                                ? "twist.angular.z is not filled: let the driver set its variance "
                                  "(twist.covariance[35]) to -1"
                                : "the unit or the track width is wrong";
    findings_.push_back("wheel odometry: in turns its turn rate is " + short_number(*wheels) +
                        " times that of the LiDAR: " + how);
  }
  if (!gyro) return;
  const bool wheels_agree = wheels && agrees(*wheels, kWheelTurnScale);
  check_gyro(*gyro, wheels_agree ? "LiDAR and wheels" : "the LiDAR");
}

void MotionAgreement::compare_gyro_and_wheels(Stamp to) {
  if (turn_windows_.any()) return;
  if (!compared_to_ || to - *compared_to_ > kLongestStep) compared_to_ = to;
  if (to - *compared_to_ < kWheelStep) return;
  const Stamp from = *compared_to_;
  const auto wheels = wheels_.between(from, to), gyro = gyro_.between(from, to);
  if (!gyro && gyro_.last() && *gyro_.last() < to) return;  // it comes
  compared_to_ = to;
  if (!wheels || !gyro || wheels->z() < 0.99 * to_seconds(to - from) || std::abs(wheels->y()) < kMinTurn)
    return;
  wheels_turned_ += std::min(std::abs(wheels->y()), gyro->norm());
  wheels_squares_ += wheels->y() * wheels->y();
  gyro_by_wheels_ += wheels->y() * *gyro;
  if (wheels_turned_ < kWheelTurnsCheckedAfter) return;
  const Eigen::Vector3d slope = gyro_by_wheels_ / wheels_squares_;
  if (turn_windows_.confirm(!agrees(slope.z(), kWheelTurnScale), from)) check_gyro(slope, "the wheels");
}

void MotionAgreement::check_gyro(const Eigen::Vector3d& slope, const std::string& others) {
  if (agrees(slope.z(), kGyroScale)) return;
  const std::string mount = ". Correct the driver, or state the IMU's mount (imu.rotation_rpy_deg)";
  int axis = 0;
  slope.cwiseAbs().maxCoeff(&axis);
  if (axis != 2 && std::abs(slope[axis]) > kOtherAxis) {
    findings_.push_back(std::string("IMU: where ") + others + " turn about z, its gyro turns about " +
                        (slope[axis] < 0.0 ? "minus " : "") + "xyz"[axis] + ": its axes are swapped" + mount);
  } else if (slope.z() < -kNothing) {
    findings_.push_back("IMU: its gyro turns right where " + others +
                        " turn left: the sign of its z axis is wrong, or the IMU is upside down" + mount);
  } else {
    findings_.push_back("IMU: in turns its gyro turns " + short_number(slope.z()) + " times as fast as " +
                        others + ": its unit, scale or mount is wrong" + mount);
  }
}

void MotionAgreement::compare_gyro_and_wheel_stamps(Stamp imu) {
  if (!wheels_.last()) return;
  const Stamp end = std::min(*wheels_.last(), imu - TurnLag::reach());
  if (!stamps_compared_to_ || end < *stamps_compared_to_ || end - *stamps_compared_to_ > kIntegralsKept)
    stamps_compared_to_ = end;
  const Stamp from = *stamps_compared_to_, to = from + kWheelStep;
  if (to > end) return;
  stamps_compared_to_ = to;
  const auto wheels = wheels_.between(from, to);
  if (!wheels || wheels->z() < 0.99 * to_seconds(to - from)) return;
  wheel_lag_.add(gyro_, from, to, wheels->y());
  if (const auto found = wheel_lag_.take_found()) report_lag(*found, "the wheels");
}

void MotionAgreement::report_lag(const TurnLag::Found& found, const std::string& other) {
  if (std::exchange(lag_reported_, true)) return;
  findings_.push_back(
      "clocks: the gyro turns " + short_number(1e3 * std::abs(found.lag)) + " ms " +
      (found.lag > 0.0 ? "after " : "before ") + other + ", by the stamps" +
      (found.at_first ? "" : ", since " + to_utc(found.since)) +
      ": one of the two stamps its samples wrongly (at the end of a sweep instead of its "
      "start, when they arrive, or by a clock of its own). Correct the driver, or synchronise "
      "both (PTP)");
}

std::optional<std::string> MotionAgreement::not_compared() const {
  if (!gyro_.last() && !wheels_.last()) return "neither the IMU nor wheels are heard";
  std::string missing;
  if (wheels_.last() && !drive_windows_.any()) append_to_list(missing, "the speed of the wheels");
  if (!turn_windows_.any()) append_to_list(missing, "turns");
  if (gyro_.last() && !lidar_lag_.first_checked()) append_to_list(missing, "stamps");
  if (missing.empty()) return std::nullopt;
  return missing + ": by the LiDAR the robot drove " + short_number(lidar_drove_) + " m and turned by " +
         short_number(lidar_turned_ / kDegree) + " deg. Drive 10 m and two turns of 90 deg";
}

std::vector<std::string> MotionAgreement::take_findings() { return std::exchange(findings_, {}); }

}  // namespace fleetmap::sensor
