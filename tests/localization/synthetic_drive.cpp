#include "localization/synthetic_drive.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <variant>

namespace fleetmap::localization::testing {

Stamp at_time(double seconds) { return stamp_from_ns(1'700'000'000'000'000'000) + from_seconds(seconds); }

Drive::Drive(double duration, double yaw0)
    : Drive(
          duration, yaw0, [](double t) { return 1.5 + 0.6 * std::sin(0.23 * t); },
          [](double t) { return 0.25 * std::sin(0.11 * t) + 0.1; }) {}

Drive::Drive(double duration, double yaw0, const Profile& speed, const Profile& turn) {
  double yaw = yaw0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; static_cast<double>(i) * kStep < duration + 1.0; ++i) {
    const double t = static_cast<double>(i) * kStep;
    Truth truth;
    truth.R = rotation_from_rpy(0.02 * std::sin(0.31 * t), 0.03 * std::sin(0.17 * t), yaw);
    truth.speed = speed(t);
    truth.v = truth.R * Eigen::Vector3d(truth.speed, 0, 0);
    truth.p = p;
    states_.push_back(truth);
    p += truth.v * kStep;
    yaw += turn(t) * kStep;
  }
}

Eigen::Vector3d Drive::angular_velocity(double t) const {
  const std::size_t i = std::max<std::size_t>(index(t), 1);
  return so3_log(states_[i - 1].R.transpose() * states_[i + 1].R) / (2 * kStep);
}

Eigen::Vector3d Drive::specific_force(double t) const {
  const std::size_t i = std::max<std::size_t>(index(t), 1);
  const Eigen::Vector3d a = (states_[i + 1].v - states_[i - 1].v) / (2 * kStep);
  return states_[i].R.transpose() * (a + Eigen::Vector3d(0, 0, 9.80665));
}

std::size_t Drive::index(double t) { return static_cast<std::size_t>(std::lround(t / kStep)); }

namespace {

/// Draws the samples of one drive, in the order of their stamps.
class Measurement {
 public:
  Measurement(const Sensors& sensors, const Drive& drive)
      : sensors_(sensors),
        drive_(drive),
        random_(sensors.seed),
        gyro_bias_(vector(sensors.gyro_bias_sigma)),
        accel_bias_(vector(sensors.accel_bias_sigma)),
        gps_error_(vector(sensors.gps_sigma)) {}

  sensor::Imu imu(double t) {
    const Eigen::Matrix3d R_imu_base = sensors_.mounting.T_base_imu.linear().transpose();
    const Eigen::Vector3d arm = sensors_.mounting.T_base_imu.translation();
    const Eigen::Vector3d w = drive_.angular_velocity(t);
    const Eigen::Vector3d f = drive_.specific_force(t) + w.cross(w.cross(arm));
    const double root_rate = std::sqrt(sensors_.imu_rate);
    sensor::Imu s{at_time(t),
                  R_imu_base * w + gyro_bias_ + vector(sensors_.gyro_noise * root_rate),
                  R_imu_base * f + accel_bias_ + vector(sensors_.accel_noise * root_rate),
                  {},
                  {}};
    s.orientation_variance.setZero();
    if (sensors_.imu_orientation) {
      s.q_enu_imu = Eigen::Quaterniond(Eigen::Matrix3d(rotation_from_rpy(0, 0, sensors_.imu_yaw_error) *
                                                       drive_.at(t).R * R_imu_base.transpose()));
    }
    return s;
  }
  sensor::Wheel wheel(double t) {
    sensor::Wheel s{at_time(t), drive_.at(t).speed + sensors_.wheel_sigma * unit_(random_), {}};
    if (sensors_.yaw_rate)
      s.yaw_rate = drive_.angular_velocity(t).z() + sensors_.wheel_yaw_rate_sigma * unit_(random_);
    return s;
  }
  sensor::Fix fix(double t) {
    const Truth& truth = drive_.at(t);
    const double sigma = sensors_.gps_sigma;
    const double keep =
        sensors_.gps_time > 0.0 ? std::exp(-1.0 / sensors_.gps_rate / sensors_.gps_time) : 0.0;
    gps_error_ = keep * gps_error_ + vector(sigma * std::sqrt(1.0 - keep * keep));
    sensor::Fix s;
    s.stamp = at_time(t);
    s.position = frame_.to_geo(truth.p + truth.R * sensors_.mounting.p_base_antenna + gps_error_);
    s.covariance = Eigen::Matrix3d::Identity() * sigma * sigma;
    if (sensors_.spoil_fix) sensors_.spoil_fix(t, s);
    return s;
  }

 private:
  Eigen::Vector3d vector(double sigma) {
    return Eigen::Vector3d(unit_(random_), unit_(random_), unit_(random_)) * sigma;
  }

  const Sensors& sensors_;
  const Drive& drive_;
  std::mt19937 random_;
  std::normal_distribution<double> unit_{0.0, 1.0};
  LocalFrame frame_{kSite};
  Eigen::Vector3d gyro_bias_, accel_bias_, gps_error_;
};

}  // namespace

std::vector<Sample> Sensors::measure(const Drive& drive, double duration) const {
  Measurement measurement(*this, drive);
  std::vector<Sample> samples;
  const auto times = static_cast<std::size_t>(duration * 1000.0);
  const auto due = [](std::size_t ms, double rate) {
    return ms % static_cast<std::size_t>(1000.0 / rate) == 0;
  };
  for (std::size_t ms = 0; ms <= times; ++ms) {
    const double t = static_cast<double>(ms) / 1000.0;
    if (imu && due(ms, imu_rate)) samples.push_back(measurement.imu(t));
    if (wheel && due(ms, wheel_rate)) samples.push_back(measurement.wheel(t));
    if (gps && due(ms, gps_rate)) {
      const sensor::Fix fix = measurement.fix(t);
      if (!gps_out || !gps_out(t)) samples.push_back(fix);
    }
  }
  return samples;
}

bool add(Ekf& ekf, const Sample& sample) {
  return std::visit([&](const auto& s) { return ekf.add(s); }, sample);
}

PoseError error_of(const GlobalPose& G, const Truth& truth) {
  const LocalFrame frame(kSite);
  const Pose T = pose_in(frame, G);
  PoseError error;
  error.position = truth.p - T.translation();
  error.rotation = so3_log(truth.R * T.linear().transpose());
  Vector6d e;
  e << error.position, error.rotation;
  error.nees = e.dot(G.covariance.ldlt().solve(e));
  const Eigen::Vector2d h = error.position.head<2>();
  error.nees_horizontal = h.dot(G.covariance.topLeftCorner<2, 2>().ldlt().solve(h));
  return error;
}

}  // namespace fleetmap::localization::testing
