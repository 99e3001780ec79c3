#include "motion_prior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "square.hpp"

namespace fleetmap::odometry {
namespace {

/// 1 sigma of the part of a pose's error that is independent from scan to scan.
constexpr double kPoseNoise = 0.003;       // m
constexpr double kRotationNoise = 0.0005;  // rad
constexpr double kNominalPeriod = 0.1;     // s, for which the accelerations of the configuration are meant

}  // namespace

MotionPrior::MotionPrior(const LoamConfig& config, const MotionState& previous, const Matrix12d& covariance,
                         double dt, const std::optional<MeasuredRotation>& gyro,
                         const std::optional<MeasuredDisplacement>& displacement)
    : dt_(dt), previous_twist_(previous.twist), twist_(previous.twist) {
  const double linear = square(config.linear_acceleration) * kNominalPeriod;  // power spectral density
  const double angular = square(config.angular_acceleration) * kNominalPeriod;
  Vector6d density, pose_noise;
  density << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(angular);
  pose_noise << Eigen::Vector3d::Constant(square(kPoseNoise)),
      Eigen::Vector3d::Constant(square(kRotationNoise));
  const Eigen::Vector3d turn_change = dt * density.tail<3>();
  turn_known_before_ = turn_change.cwiseQuotient(covariance.diagonal().tail<3>() + turn_change);

  Pose way = se3_exp(dt * twist_);
  Matrix12d F = Matrix12d::Identity(), Q = Matrix12d::Zero();
  F.topRightCorner<6, 6>().diagonal().setConstant(dt);
  Q.diagonal() << dt * dt * dt / 3.0 * density + pose_noise, dt * density;
  Q.topRightCorner<6, 6>().diagonal() = Q.bottomLeftCorner<6, 6>().diagonal() = 0.5 * dt * dt * density;
  if (gyro) {
    way.linear() = gyro->R_previous_now;
    for (int axis = 3; axis < 6; ++axis) {
      F(axis, axis + 6) = Q(axis, axis + 6) = Q(axis + 6, axis) = 0.0;
      Q(axis, axis) = square(gyro->sigma) + square(kRotationNoise);
    }
  }
  if (gyro && displacement) {
    way.translation() = displacement->p_previous_now;
    for (int axis = 0; axis < 3; ++axis) {
      F(axis, axis + 6) = Q(axis, axis + 6) = Q(axis + 6, axis) = 0.0;
      Q(axis, axis) = square(displacement->sigma) + square(kPoseNoise);
    }
  }
  F.topLeftCorner<6, 6>() = adjoint(way.inverse());
  T_odom_base_ = previous.T_odom_base * way;
  covariance_ = F * covariance * F.transpose() + Q;
}

/// Kalman update by one component of the velocity. It also corrects the pose, as far as the errors of both
/// are correlated.
void MotionPrior::measure_rate(int axis, double value, double sigma) {
  const Eigen::Index i = 6 + axis;
  const Vector12d gain = covariance_.col(i) / (covariance_(i, i) + square(sigma));
  const Vector12d correction = gain * (value - twist_[axis]);
  covariance_ -= (gain * covariance_.row(i)).eval();
  T_odom_base_ = T_odom_base_ * se3_exp(correction.head<6>());
  twist_ += correction.tail<6>();
}

void MotionPrior::set_gyro_rate(const Eigen::Vector3d& rate, double sigma) {
  for (int axis = 0; axis < 3; ++axis) measure_rate(3 + axis, rate[axis], sigma);
  has_gyro_rate_ = true;
}

void MotionPrior::set_forward_speed(double speed, double sigma) {
  measure_rate(0, speed, sigma);
  has_forward_speed_ = true;
}

void MotionPrior::set_no_sideslip(double sigma) { measure_rate(1, 0.0, sigma); }

void MotionPrior::set_yaw_rate(double rate, double sigma) {
  measure_rate(5, rate, sigma);
  has_yaw_rate_ = true;
}

Eigen::Vector3d MotionPrior::turn_acceleration(const Vector6d& twist) const {
  if (turn_acceleration_) return *turn_acceleration_;
  return 0.5 * turn_known_before_.cwiseProduct((twist - previous_twist_).tail<3>()) / dt_;
}

MotionState MotionPrior::predicted() const { return {T_odom_base_, twist_, turn_acceleration(twist_)}; }

double MotionPrior::position_sigma() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(covariance_.topLeftCorner<3, 3>()), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
}

NormalEquations MotionPrior::linearised(const MotionState& state) const {
  Vector12d residual;
  residual << se3_log(T_odom_base_.inverse() * state.T_odom_base), state.twist - twist_;
  NormalEquations result;
  const Matrix12d information = covariance_.ldlt().solve(Matrix12d::Identity());
  result.H = 0.5 * (information + information.transpose());
  result.g = result.H * residual;
  return result;
}

}  // namespace fleetmap::odometry
