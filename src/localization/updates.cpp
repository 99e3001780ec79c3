#include "updates.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prediction.hpp"

namespace fleetmap::localization {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Jacobian = Eigen::Matrix<double, 3, kStates>;

/// Variance of the white noise, sampled each `dt`, that is as informative as errors of variance `variance`
/// that persist for `time` seconds: both give the same variance to the mean over a long time.
double as_white(double time, double dt) { return std::max(1.0, 2.0 * time / std::max(dt, 1e-3)); }

void correct(Filter& filter, const ErrorState& dx) {
  filter.p += dx.segment<3>(kPos);
  filter.v += dx.segment<3>(kVel);
  filter.R = Eigen::Quaterniond(so3_exp(dx.segment<3>(kAtt)) * filter.R).normalized().toRotationMatrix();
  filter.gyro_bias += dx.segment<3>(kGyroBias);
  filter.accel_bias += dx.segment<3>(kAccelBias);
  filter.gps_error += dx.segment<3>(kGpsError);
}

template <int Rows>
void kalman(Filter& filter, const Eigen::Matrix<double, Rows, kStates>& H,
            const Eigen::Matrix<double, Rows, 1>& residual, const Eigen::Matrix<double, Rows, Rows>& noise) {
  const Eigen::Matrix<double, kStates, Rows> PHt = filter.P * H.transpose();
  const Eigen::Matrix<double, Rows, Rows> S = H * PHt + noise;
  const Eigen::Matrix<double, kStates, Rows> K = PHt * S.inverse();  // S >= noise > 0
  correct(filter, K * residual);
  // Joseph's form: stays positive definite when a fix is far better than the prediction.
  const Covariance IKH = Covariance::Identity() - K * H;
  const Covariance P = IKH * filter.P * IKH.transpose() + K * noise * K.transpose();
  filter.P = 0.5 * (P + P.transpose());
}

/// v_base = R^T v and its derivative.
Jacobian body_velocity_jacobian(const Filter& filter) {
  Jacobian H = Jacobian::Zero();
  H.block<3, 3>(0, kVel) = filter.R.transpose();
  H.block<3, 3>(0, kAtt) = filter.R.transpose() * skew(filter.v);
  return H;
}

double turn_rate(const EkfConfig& config, const Filter& filter) {
  if (filter.last_imu && to_seconds(filter.stamp - filter.last_imu->stamp) <= config.imu.max_gap) {
    return (config.mounting.T_base_imu.linear() * (filter.last_imu->angular_velocity - filter.gyro_bias)).z();
  }
  const sensor::Wheel* wheel = recent_wheel(config, filter);
  return wheel != nullptr && wheel->yaw_rate ? *wheel->yaw_rate : 0.0;
}

double lateral_variance(const EkfConfig& config, const Filter& filter) {
  const double slide = turn_rate(config, filter) * config.wheel.turn_offset;
  return config.wheel.lateral_sigma * config.wheel.lateral_sigma + slide * slide;
}

void update_gyro_bias(const EkfConfig& config, Filter& filter, double yaw_rate, double inflation) {
  if (!filter.last_imu || to_seconds(filter.stamp - filter.last_imu->stamp) > config.imu.max_gap) return;
  const Eigen::RowVector3d axis = config.mounting.T_base_imu.linear().row(2);
  Eigen::Matrix<double, 1, kStates> H = Eigen::Matrix<double, 1, kStates>::Zero();
  H.segment<3>(kGyroBias) = -axis;
  const Eigen::Matrix<double, 1, 1> residual(yaw_rate -
                                             axis.dot(filter.last_imu->angular_velocity - filter.gyro_bias));
  double variance = config.wheel.yaw_rate_sigma * config.wheel.yaw_rate_sigma * inflation;
  // Wheels slip in turns, so their error there is not evidence about the gyro bias.
  const double expected = variance + (H * filter.P * H.transpose()).value();
  const double excess = residual(0) * residual(0) / expected / config.wheel.gate;
  if (excess > 1.0) variance *= excess * excess;
  kalman<1>(filter, H, residual, Eigen::Matrix<double, 1, 1>(variance));
}

}  // namespace

void update_from_wheel(const EkfConfig& config, Filter& filter, const sensor::Wheel& wheel) {
  const WheelModel& model = config.wheel;
  const double dt =
      filter.last_wheel ? to_seconds(wheel.stamp - filter.last_wheel->stamp) : model.correlation_time;
  const double inflation = as_white(model.correlation_time, dt);
  filter.last_wheel = wheel;
  ++filter.counters.wheel_used;
  if (wheel.yaw_rate && filter.attitude_set) update_gyro_bias(config, filter, *wheel.yaw_rate, inflation);
  if (filter.phase != Phase::kTracking) return;

  const double scale = model.speed_scale * wheel.forward_speed;
  const Vector3d variance(model.speed_sigma * model.speed_sigma + scale * scale,
                          lateral_variance(config, filter), model.vertical_sigma * model.vertical_sigma);
  const Jacobian H = body_velocity_jacobian(filter);
  const Vector3d residual = Vector3d(wheel.forward_speed, 0, 0) - filter.R.transpose() * filter.v;
  Matrix3d noise = (variance * inflation).asDiagonal();
  const Matrix3d S = H * filter.P * H.transpose() + noise;
  const double excess = residual.dot(S.inverse() * residual) / model.gate;
  if (excess > 1.0) {
    noise *= excess * excess;
    ++filter.counters.wheel_downweighted;
  }
  kalman<3>(filter, H, residual, noise);
}

void update_nonholonomic(const EkfConfig& config, Filter& filter) {
  const Jacobian full = body_velocity_jacobian(filter);
  const Eigen::Matrix<double, 2, kStates> H = full.bottomRows<2>();
  const Eigen::Vector2d residual = -(filter.R.transpose() * filter.v).tail<2>();
  const Eigen::Vector2d variance(lateral_variance(config, filter),
                                 config.wheel.vertical_sigma * config.wheel.vertical_sigma);
  const Eigen::Matrix2d noise = (variance * as_white(config.wheel.correlation_time, 0.1)).asDiagonal();
  kalman<2>(filter, H, residual, noise);
}

void update_from_gravity(const EkfConfig& config, Filter& filter, const sensor::Imu& imu, double dt) {
  const Matrix3d R_base_imu = config.mounting.T_base_imu.linear();
  const Vector3d f = R_base_imu * (imu.specific_force - filter.accel_bias);
  const Vector3d w = R_base_imu * (imu.angular_velocity - filter.gyro_bias);
  const sensor::Wheel* wheel = recent_wheel(config, filter);
  const Vector3d v_base(wheel != nullptr ? wheel->forward_speed : 0.0, 0, 0);
  const Vector3d up(0, 0, config.imu.gravity);
  Jacobian H = Jacobian::Zero();
  H.block<3, 3>(0, kAtt) = filter.R.transpose() * skew(up);
  H.block<3, 3>(0, kAccelBias) = R_base_imu;
  const Vector3d residual = f - filter.R.transpose() * up - w.cross(v_base);
  const double sigma = 0.5 + std::abs(f.norm() - config.imu.gravity);  // m/s^2: starting, braking, bumps
  const Matrix3d noise = Matrix3d::Identity() * (sigma * sigma * as_white(1.0, dt));
  kalman<3>(filter, H, residual, noise);
}

bool update_from_position(const EkfConfig& config, Filter& filter, const Vector3d& p_enu_antenna,
                          const Matrix3d& R) {
  const double slow = config.gps.correlation_time > 0.0 ? config.gps.correlated_share : 0.0;
  const Vector3d arm = filter.R * config.mounting.p_base_antenna;
  Jacobian H = Jacobian::Zero();
  H.block<3, 3>(0, kPos) = Matrix3d::Identity();
  H.block<3, 3>(0, kAtt) = -skew(arm);
  const Matrix3d L = (slow * R).llt().matrixL();
  if (slow > 0.0) H.block<3, 3>(0, kGpsError) = L;
  const Matrix3d noise = (1.0 - slow) * R;
  const Vector3d residual =
      p_enu_antenna - filter.p - arm - (slow > 0.0 ? Vector3d(L * filter.gps_error) : Vector3d::Zero());
  // Gated as if the whole of R were white: a receiver less correlated than the model must not be shut out.
  const Matrix3d S = H * filter.P * H.transpose() + R;
  if (!(residual.dot(S.inverse() * residual) <= config.gps.gate)) return false;
  kalman<3>(filter, H, residual, noise);
  return true;
}

void lose_heading(const EkfConfig& config, Filter& filter) {
  const double speed2 = config.motion.speed_sigma * config.motion.speed_sigma;
  const Matrix3d P_position = filter.P.block<3, 3>(kPos, kPos);
  filter.phase = Phase::kCoarse;
  filter.heading_set = false;
  filter.P.topRows<6>().setZero();
  filter.P.leftCols<6>().setZero();
  filter.P.row(kAtt + 2).setZero();
  filter.P.col(kAtt + 2).setZero();
  filter.P.block<3, 3>(kPos, kPos) = P_position;
  filter.P.diagonal().segment<3>(kVel).setConstant(speed2);
  filter.P(kAtt + 2, kAtt + 2) = std::numbers::pi * std::numbers::pi / 3.0;
}

}  // namespace fleetmap::localization
