#include "motion_sensors.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace fleetmap::odometry {
namespace {

constexpr Duration kHold = std::chrono::milliseconds(150);  // how long the outermost sample is held
constexpr double kMaxDeadReckoning = 120.0;                 // s
constexpr double kWheelStep = 0.05;                         // s
constexpr double kWheelSlip = 0.03;                         // m a m, 1 sigma
constexpr double kWheelSigma = 0.02;                        // m, 1 sigma at no distance
constexpr double kSpeedShare = 0.05;                        // of the speed, added to its sigma
constexpr double kTurningAxis = 0.5;                        // m, 1 sigma, from base_link
constexpr double kBiasGain = 0.02;

}  // namespace

bool MotionSensors::add(const sensor::Imu& imu) {
  return gyro_.add(imu.stamp, config_.q_base_imu * imu.angular_velocity);
}

bool MotionSensors::add(const sensor::Wheel& wheel) {
  const double yaw_rate = wheel.yaw_rate.value_or(0.0);
  return wheels_.add(wheel.stamp, {wheel.forward_speed, yaw_rate, wheel.yaw_rate ? 1.0 : 0.0});
}

MotionPrior MotionSensors::prior(const MotionState& previous, const Matrix12d& covariance,
                                 const SweepTimes& times) const {
  std::optional<MotionPrior::MeasuredRotation> rotation;
  if (const auto R = gyro_.rotation(times.previous, times.reference, gyro_bias_, kHold)) {
    rotation = {*R, config_.gyro_noise * times.dt};
  }
  const auto moved = times.dt > kScanGap ? displacement(times.previous, times.reference) : std::nullopt;
  MotionPrior prior(config_, previous, covariance, times.dt, rotation, moved);
  const Stamp from = times.reference - from_seconds(times.half_sweep);
  const Stamp to = times.reference + from_seconds(times.half_sweep);
  if (const auto rate = gyro_.mean(from, to, kHold)) {
    prior.set_gyro_rate(*rate - gyro_bias_, config_.gyro_noise);
  }
  if (const auto trend = gyro_.trend(from, to)) prior.set_turn_acceleration(trend->slope);
  if (const auto wheel = wheels_.mean(from, to, kHold)) {
    prior.set_forward_speed(wheel->x(), config_.wheel_speed_noise + kSpeedShare * std::abs(wheel->x()));
    // A base_link beside the axis that the robot turns about moves sideways in turns.
    prior.set_no_sideslip(config_.wheel_speed_noise + kSpeedShare * std::abs(wheel->x()) +
                          kTurningAxis * prior.predicted().twist.tail<1>().norm());
    if (wheel->z() > 0.99) prior.set_yaw_rate(wheel->y(), config_.wheel_yaw_noise);
  }
  return prior;
}

std::optional<MotionPrior::MeasuredDisplacement> MotionSensors::displacement(Stamp from, Stamp to) const {
  if (to_seconds(to - from) > kMaxDeadReckoning) return std::nullopt;
  const auto steps = static_cast<int>(std::ceil(to_seconds(to - from) / kWheelStep));
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double length = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Stamp begin = from + (to - from) * k / steps, end = from + (to - from) * (k + 1) / steps;
    const auto wheel = wheels_.mean(begin, end, kHold);
    const auto turn = gyro_.rotation(begin, end, gyro_bias_, kHold);
    if (!wheel || !turn) return std::nullopt;
    const double step = wheel->x() * to_seconds(end - begin);
    p += R * Eigen::Vector3d(step, 0.0, 0.0);
    R = R * *turn;
    length += std::abs(step);
  }
  return MotionPrior::MeasuredDisplacement{p, kWheelSlip * length + kWheelSigma};
}

bool MotionSensors::moving(Stamp from, Stamp to) const {
  const auto wheel = wheels_.mean(from, to, kHold);
  const auto rate = gyro_.mean(from, to, kHold);
  const bool still =
      (!wheel || std::abs(wheel->x()) < kMovingSpeed) && (!rate || (*rate - gyro_bias_).norm() < kMovingRate);
  return !still;
}

std::optional<RateHistory::Trend> MotionSensors::turn_acceleration(Stamp reference, double half_sweep) const {
  return gyro_.trend(reference - from_seconds(half_sweep), reference + from_seconds(half_sweep));
}

void MotionSensors::learn_gyro_bias(Stamp from, Stamp to, const Eigen::Matrix3d& R_from_to_lidar) {
  const double dt = to_seconds(to - from);
  const auto R = gyro_.rotation(from, to, Eigen::Vector3d::Zero(), kHold);
  if (!R || dt > kScanGap) return;
  const Eigen::Vector3d bias = so3_log(R_from_to_lidar.transpose() * *R) / dt;
  const double gain = std::max(kBiasGain, 1.0 / (++bias_samples_ + 10.0));
  gyro_bias_ += gain * (bias - gyro_bias_);
}

}  // namespace fleetmap::odometry
