#include "fleetmap/odometry/motion_covariance.hpp"

namespace fleetmap::odometry {

void MotionCovariance::add(const Pose& T_odom_base, const Matrix6d& growth, const Matrix6d& pose_noise) {
  if (started_) {
    const Matrix6d A = adjoint(T_odom_base.inverse() * T_odom_base_);
    growth_ = (A * growth_ * A.transpose() + growth).eval();
    reference_noise_ = (A * reference_noise_ * A.transpose()).eval();
    moved_ = true;
  } else {
    started_ = true;
    reference_noise_ = pose_noise;
  }
  T_odom_base_ = T_odom_base;
  last_noise_ = pose_noise;
}

void MotionCovariance::restart() {
  growth_.setZero();
  reference_noise_ = last_noise_;
  moved_ = false;
}

Matrix6d MotionCovariance::since_reference() const {
  if (!moved_) return Matrix6d::Zero();
  const Matrix6d sum = growth_ + reference_noise_ + last_noise_;
  return 0.5 * (sum + sum.transpose());
}

Matrix6d MotionCovariance::drift_since_reference() const { return 0.5 * (growth_ + growth_.transpose()); }

}  // namespace fleetmap::odometry
