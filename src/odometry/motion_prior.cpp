#include "fleetmap/odometry/motion_prior.hpp"

namespace fleetmap::odometry {
namespace {

/// 1 sigma of the last pose in the map.
constexpr double kPoseNoise = 0.003;       // m
constexpr double kRotationNoise = 0.0005;  // rad
constexpr double kNominalPeriod = 0.1;     // s, for which the accelerations of the configuration are meant

double square(double value) { return value * value; }

}  // namespace

MotionPrior::MotionPrior(const LoamConfig& config, const MotionState& previous,
                         const Vector6d& twist_variance, double dt)
    : previous_(previous), dt_(dt), twist_mean_(previous.twist) {
  const double linear = square(config.linear_acceleration) * kNominalPeriod;  // power spectral density
  const double angular = square(config.angular_acceleration) * kNominalPeriod;
  Vector6d density, pose_noise;
  density << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(angular);
  pose_noise << Eigen::Vector3d::Constant(square(kPoseNoise)),
      Eigen::Vector3d::Constant(square(kRotationNoise));
  const Vector6d change = dt * density;
  twist_information_ = (twist_variance + change).cwiseInverse();
  smoothing_ = twist_variance.cwiseProduct(twist_information_);
  // Of the way, given the velocity now: what is then still unknown of the velocity before, and of the course
  // between the two.
  pose_information_ =
      (0.25 * dt * dt * smoothing_.cwiseProduct(change) + dt * dt * dt / 12.0 * density + pose_noise)
          .cwiseInverse();
}

/// A measurement of one component of the velocity, merged with what the last state says about it.
void MotionPrior::replace_rate(int axis, double value, double sigma) {
  const double information = 1.0 / square(sigma);
  const double total = twist_information_[axis] + information;
  twist_mean_[axis] = (twist_information_[axis] * twist_mean_[axis] + information * value) / total;
  twist_information_[axis] = total;
}

void MotionPrior::set_gyro_rate(const Eigen::Vector3d& rate, double sigma) {
  for (int axis = 0; axis < 3; ++axis) replace_rate(3 + axis, rate[axis], sigma);
}

void MotionPrior::set_gyro_rotation(const Eigen::Matrix3d& R_previous_now, double sigma) {
  R_previous_now_ = R_previous_now;
  rotation_information_ = 1.0 / (square(sigma) + square(kRotationNoise));
}

void MotionPrior::set_forward_speed(double speed, double sigma) { replace_rate(0, speed, sigma); }

void MotionPrior::set_yaw_rate(double rate, double sigma) { replace_rate(5, rate, sigma); }

/// Mean of the velocity now and of the one before; of that the velocity now tells more the less was known of
/// it, or a way nobody saw would be certain while the velocity is not.
Vector6d MotionPrior::mean_twist(const Vector6d& now) const {
  const Vector6d before = previous_.twist + smoothing_.cwiseProduct(now - previous_.twist);
  return 0.5 * (before + now);
}

Eigen::Vector3d MotionPrior::turn_acceleration(const Vector6d& twist) const {
  if (turn_acceleration_) return *turn_acceleration_;
  // As far as the velocity before was known.
  const Eigen::Vector3d share = 0.5 * (Eigen::Vector3d::Ones() - smoothing_.tail<3>());
  return share.cwiseProduct((twist - previous_.twist).tail<3>()) / dt_;
}

MotionState MotionPrior::predicted() const {
  MotionState state;
  state.twist = twist_mean_;
  state.turn_acceleration = turn_acceleration(twist_mean_);
  state.T_odom_base = previous_.T_odom_base * se3_exp(dt_ * mean_twist(twist_mean_));
  if (R_previous_now_) state.T_odom_base.linear() = previous_.T_odom_base.linear() * *R_previous_now_;
  return state;
}

NormalEquations MotionPrior::linearised(const MotionState& state) const {
  NormalEquations result;
  const Vector6d twist_residual = state.twist - twist_mean_;
  result.H.diagonal().tail<6>() = twist_information_;
  result.g.tail<6>() = twist_information_.cwiseProduct(twist_residual);

  const Pose expected = previous_.T_odom_base * se3_exp(dt_ * mean_twist(state.twist));
  Vector6d pose_residual = se3_log(expected.inverse() * state.T_odom_base);
  Vector6d information = pose_information_;
  Vector6d slope = -0.5 * dt_ * (Vector6d::Ones() + smoothing_);  // d pose_residual / d twist
  if (R_previous_now_) {
    const Eigen::Matrix3d R_expected = previous_.T_odom_base.linear() * *R_previous_now_;
    pose_residual.tail<3>() = so3_log(R_expected.transpose() * state.T_odom_base.linear());
    information.tail<3>().setConstant(rotation_information_);
    slope.tail<3>().setZero();
  }
  for (int i = 0; i < 6; ++i) {
    result.H(i, i) += information[i];
    result.H(i, i + 6) += information[i] * slope[i];
    result.H(i + 6, i) += information[i] * slope[i];
    result.H(i + 6, i + 6) += information[i] * slope[i] * slope[i];
    result.g[i] += information[i] * pose_residual[i];
    result.g[i + 6] += information[i] * slope[i] * pose_residual[i];
  }
  return result;
}

}  // namespace fleetmap::odometry
