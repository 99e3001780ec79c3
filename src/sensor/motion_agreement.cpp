#include "fleetmap/sensor/motion_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fleetmap/core/text_list.hpp"
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
// A lag that is one: as large, and leaving so little of the misfit.
constexpr double kMinLag = 0.05, kMisfitLeft = 0.5;  // s
constexpr std::size_t kStampSteps = 25;

bool agrees(double slope, double scale) { return slope > 1.0 / scale && slope < scale; }

const char* wheel_unit_of(double scale) {
  if (std::abs(scale - 3.6) < 0.4) return ": its unit seems to be km/h and not m/s";
  if (std::abs(scale - 2.24) < 0.15) return ": its unit seems to be miles per hour and not m/s";
  if (scale > 500.0 && scale < 1500.0) return ": its unit seems to be mm/s and not m/s";
  return ": the diameter of the wheels, the gear or the unit is wrong";
}

}  // namespace

void MotionAgreement::add(const Imu& imu) {
  gyro_.add(imu.stamp, q_base_imu_ * imu.angular_velocity);
  // The one that comes later has both.
  if (wheels_.last() && *wheels_.last() <= imu.stamp) compare_gyro_and_wheels(*wheels_.last());
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
  const Duration reach = from_seconds((kLags + 1) * kLagStep);
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
  compare_stamps(step);
}

void MotionAgreement::compare_drive(const Step& step) {
  const auto wheels = wheels_.between(step.from, step.to);
  if (drive_checked_ || !wheels || step.moved.norm() < kMinMove) return;
  driven_ += step.moved.norm();
  drive_squares_ += step.moved.squaredNorm();
  drive_products_ += wheels->x() * step.moved;
  if (driven_ > kCheckedAfter) check_drive();
}

void MotionAgreement::check_drive() {
  drive_checked_ = true;
  const Eigen::Vector2d slope = drive_products_ / drive_squares_;
  const double scale = slope.norm();
  const std::string since = " over the first " + short_number(driven_) + " m";
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
  if (turns_checked_ || std::abs(step.turned) < kMinTurn) return;
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
  turns_checked_ = true;
  const bool with_gyro = gyro_turned_ > 0.5 * kTurnsCheckedAfter;
  const bool with_wheels = wheel_turned_ > 0.5 * kTurnsCheckedAfter;
  const double gyro = with_gyro ? gyro_products_.z() / gyro_squares_ : 0.0;
  const double wheels = with_wheels ? wheel_products_ / wheel_squares_ : 0.0;
  if (with_gyro && with_wheels && gyro < -kNothing && wheels < -kNothing) {
    findings_.emplace_back(
        "LiDAR: it turns right where gyro and wheels turn left: its points are mirrored (left-handed axes, "
        "or a "
        "device that turns the other way), or it is mounted upside down and lidar.rotation_rpy_deg does not "
        "say so");
    return;
  }
  if (with_wheels && !agrees(wheels, kWheelTurnScale)) {
    const std::string how = wheels < -kNothing ? "the sign of twist.angular.z is wrong"
                            : wheels < kNothing
                                ? "twist.angular.z is not filled: let the driver set its variance "
                                  "(twist.covariance[35]) to -1"
                                : "the unit or the track width is wrong";
    findings_.push_back("wheel odometry: in turns its turn rate is " + short_number(wheels) +
                        " times that of the LiDAR: " + how);
  }
  if (!with_gyro) return;
  const bool wheels_agree = with_wheels && agrees(wheels, kWheelTurnScale);
  check_gyro(gyro_products_ / gyro_squares_, wheels_agree ? "LiDAR and wheels" : "the LiDAR");
}

void MotionAgreement::compare_gyro_and_wheels(Stamp to) {
  if (turns_checked_) return;
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
  turns_checked_ = true;
  const Eigen::Vector3d slope = gyro_by_wheels_ / wheels_squares_;
  if (!agrees(slope.z(), kWheelTurnScale)) check_gyro(slope, "the wheels");
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

void MotionAgreement::compare_stamps(const Step& step) {
  if (stamps_checked_) return;
  std::array<double, 2 * kLags + 1> misfits{};
  for (int k = -kLags; k <= kLags; ++k) {
    const Duration lag = from_seconds(k * kLagStep);
    const auto gyro = gyro_.between(step.from + lag, step.to + lag);
    if (!gyro) return;
    const double misfit = gyro->z() - step.turned;
    misfits.at(static_cast<std::size_t>(k + kLags)) = misfit * misfit;
  }
  for (std::size_t k = 0; k < misfits.size(); ++k) misfits_.at(k) += misfits.at(k);
  // A lag shows where the turn rate changes; in steady turns and at standstill it does not.
  const auto [smallest, largest] = std::ranges::minmax_element(misfits);
  misfit_steps_ += *largest - *smallest > kMinTurn * kMinTurn / 4.0 ? 1 : 0;
  if (misfit_steps_ >= kStampSteps) check_stamps();
}

void MotionAgreement::check_stamps() {
  stamps_checked_ = true;
  const auto best = std::ranges::min_element(misfits_);
  const double lag = (static_cast<double>(best - misfits_.begin()) - kLags) * kLagStep;
  if (std::abs(lag) < kMinLag || *best > kMisfitLeft * misfits_.at(kLags)) return;
  findings_.push_back(
      "clocks: the gyro turns " + short_number(1e3 * std::abs(lag)) + " ms " +
      (lag > 0.0 ? "after" : "before") +
      " the LiDAR, by the stamps: one of the two stamps its samples wrongly (at the end of a sweep "
      "instead of its start, when they arrive, or by a clock of its own). Correct the driver, or "
      "synchronise both (PTP)");
}

std::optional<std::string> MotionAgreement::not_compared() const {
  if (!gyro_.last() && !wheels_.last()) return "neither the IMU nor wheels are heard";
  std::string missing;
  if (wheels_.last() && !drive_checked_) append_to_list(missing, "the speed of the wheels");
  if (!turns_checked_) append_to_list(missing, "turns");
  if (gyro_.last() && !stamps_checked_) append_to_list(missing, "stamps");
  if (missing.empty()) return std::nullopt;
  return missing + ": by the LiDAR the robot drove " + short_number(lidar_drove_) + " m and turned by " +
         short_number(lidar_turned_ / kDegree) + " deg. Drive 10 m and two turns of 90 deg";
}

std::vector<std::string> MotionAgreement::take_findings() { return std::exchange(findings_, {}); }

}  // namespace fleetmap::sensor
