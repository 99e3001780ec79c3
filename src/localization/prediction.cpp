#include "prediction.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::localization {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void propagate(const EkfConfig& config, Filter& filter, double dt, Covariance F, Covariance Q) {
  if (config.gps.correlation_time > 0.0) {
    const double keep = std::exp(-dt / config.gps.correlation_time);
    F.block<3, 3>(kGpsError, kGpsError) *= keep;
    Q.diagonal().segment<3>(kGpsError).array() += 1.0 - keep * keep;
    filter.gps_error *= keep;
  }
  Q.diagonal().segment<3>(kGyroBias).array() += config.imu.gyro_bias_walk * config.imu.gyro_bias_walk * dt;
  Q.diagonal().segment<3>(kAccelBias).array() += config.imu.accel_bias_walk * config.imu.accel_bias_walk * dt;
  const Covariance FP = F * filter.P;
  filter.P.noalias() = FP * F.transpose();
  filter.P += Q;
  filter.P = (0.5 * (filter.P + filter.P.transpose())).eval();
}

/// White acceleration of variance rate `q` per axis, integrated twice.
void add_velocity_noise(Covariance& Q, double q, double dt) {
  for (int i = 0; i < 3; ++i) {
    Q(kVel + i, kVel + i) += q * dt;
    Q(kPos + i, kPos + i) += q * dt * dt * dt / 3.0;
    Q(kPos + i, kVel + i) += 0.5 * q * dt * dt;
    Q(kVel + i, kPos + i) += 0.5 * q * dt * dt;
  }
}

/// Updates the track for the heading from motion. In the coarse phase the position is held and its
/// covariance grows instead.
void reckon(const EkfConfig& config, Filter& filter, double dt, double turn) {
  const sensor::Wheel* wheel = recent_wheel(config, filter);
  if (wheel != nullptr) {
    filter.alignment.advance(wheel->forward_speed * dt, filter.yaw_turned + 0.5 * turn);
  }
  filter.yaw_turned += turn;
  if (filter.phase == Phase::kCoarse) {
    const double step = (wheel != nullptr ? std::abs(wheel->forward_speed) : config.motion.speed_sigma) * dt;
    // Errors along an unknown but steady direction add up, they do not average out.
    for (int i = 0; i < 3; ++i) {
      double& variance = filter.P(kPos + i, kPos + i);
      variance = std::pow(std::sqrt(std::max(0.0, variance)) + step, 2);
    }
  }
}

}  // namespace

double yaw_of(const Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

const sensor::Wheel* recent_wheel(const EkfConfig& config, const Filter& filter) {
  if (!filter.last_wheel) return nullptr;
  return to_seconds(filter.stamp - filter.last_wheel->stamp) <= config.wheel.timeout ? &*filter.last_wheel
                                                                                     : nullptr;
}

void predict_inertial(const EkfConfig& config, Filter& filter, double dt, const Vector3d& angular_velocity,
                      const Vector3d& specific_force, const Vector3d& rate_change,
                      const Vector3d& force_change) {
  const Matrix3d R_base_imu = config.mounting.T_base_imu.linear();
  const Vector3d p_base_imu = config.mounting.T_base_imu.translation();
  const Vector3d w = R_base_imu * (angular_velocity - filter.gyro_bias);
  // Centripetal part of the IMU's lever arm; the part of angular acceleration averages out over a manoeuvre.
  const Vector3d f = R_base_imu * (specific_force - filter.accel_bias) - w.cross(w.cross(p_base_imu));
  const Matrix3d R_middle = filter.R * so3_exp(0.5 * dt * w);
  const Vector3d Rf = R_middle * f;

  const double yaw_before = yaw_of(filter.R);
  filter.R = Eigen::Quaterniond(filter.R * so3_exp(dt * w)).normalized().toRotationMatrix();
  const double turn = wrap_angle(yaw_of(filter.R) - yaw_before);

  Covariance F = Covariance::Identity();
  Covariance Q = Covariance::Zero();
  const Matrix3d R_imu = R_middle * R_base_imu;
  F.block<3, 3>(kAtt, kGyroBias) = -R_imu * dt;
  // The motion between two samples is uncertain by about their difference.
  const double rate_q = config.imu.gyro_noise * config.imu.gyro_noise + rate_change.squaredNorm() / 36.0 * dt;
  Q.diagonal().segment<3>(kAtt).array() += rate_q * dt;
  if (filter.phase == Phase::kTracking) {
    const Vector3d a = Rf - Vector3d(0, 0, config.imu.gravity);
    filter.p += dt * filter.v + 0.5 * dt * dt * a;
    filter.v += dt * a;
    const Matrix3d tilt = skew(Rf);
    F.block<3, 3>(kPos, kVel) = Matrix3d::Identity() * dt;
    F.block<3, 3>(kPos, kAtt) = -0.5 * dt * dt * tilt;
    F.block<3, 3>(kPos, kAccelBias) = -0.5 * dt * dt * R_imu;
    F.block<3, 3>(kVel, kAtt) = -dt * tilt;
    F.block<3, 3>(kVel, kAccelBias) = -dt * R_imu;
    const double force_q =
        config.imu.accel_noise * config.imu.accel_noise + force_change.squaredNorm() / 36.0 * dt;
    add_velocity_noise(Q, force_q, dt);
  }
  propagate(config, filter, dt, F, Q);
  reckon(config, filter, dt, turn);
}

void predict_by_motion_model(const EkfConfig& config, Filter& filter, double dt) {
  const sensor::Wheel* wheel = recent_wheel(config, filter);
  const bool turn_known = wheel != nullptr && wheel->yaw_rate.has_value();
  const double turn = turn_known ? *wheel->yaw_rate * dt : 0.0;
  const Matrix3d Rz = rotation_from_rpy(0, 0, turn);
  const double level = std::exp(-dt / config.motion.tilt_time);

  const Vector3d rpy = rpy_from_rotation(filter.R);
  filter.R = rotation_from_rpy(level * rpy.x(), level * rpy.y(), rpy.z() + turn);

  Covariance F = Covariance::Identity();
  Covariance Q = Covariance::Zero();
  F.block<3, 3>(kAtt, kAtt) = Rz * Vector3d(level, level, 1.0).asDiagonal();
  const double tilt2 = config.motion.tilt_sigma * config.motion.tilt_sigma * (1.0 - level * level);
  Q(kAtt, kAtt) += tilt2;
  Q(kAtt + 1, kAtt + 1) += tilt2;
  const double yaw_sigma = turn_known ? config.motion.yaw_noise_with_wheels : config.motion.yaw_noise;
  const double yaw_q = yaw_sigma * yaw_sigma * dt;
  if (filter.phase == Phase::kTracking) {
    filter.p += dt * rotation_from_rpy(0, 0, 0.5 * turn) * filter.v;
    filter.v = Rz * filter.v;
    F.block<3, 3>(kPos, kVel) = Matrix3d::Identity() * dt;
    F.block<3, 3>(kVel, kVel) = Rz;
    add_velocity_noise(Q, config.motion.accel_noise * config.motion.accel_noise, dt);
    // A robot that turns by an unknown angle turns its velocity, too.
    ErrorState turning = ErrorState::Zero();
    turning.segment<3>(kVel) = Vector3d::UnitZ().cross(filter.v);
    turning.segment<3>(kPos) = 0.5 * dt * turning.segment<3>(kVel);
    turning(kAtt + 2) = 1.0;
    Q += turning * turning.transpose() * yaw_q;
  } else {
    Q(kAtt + 2, kAtt + 2) += yaw_q;
  }
  propagate(config, filter, dt, F, Q);
  reckon(config, filter, dt, turn);
}

}  // namespace fleetmap::localization
