#include "fleetmap/geometry/se3.hpp"

#include <cmath>
#include <numbers>

#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap {
namespace {

constexpr double kSmallAngle = 1e-5;

/// Left Jacobian of SO(3): translation of exp(xi) is V(phi) rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double theta2 = phi.squaredNorm();
  const double theta = std::sqrt(theta2);
  const Eigen::Matrix3d W = skew(phi);
  if (theta < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6.0;
  const auto [sin, cos] = portable::sin_cos(theta);
  return Eigen::Matrix3d::Identity() + (1.0 - cos) / theta2 * W + (theta - sin) / (theta2 * theta) * W * W;
}

/// Turn by `angle` (rad) about a unit vector.
Eigen::Quaterniond turn(double angle, const Eigen::Vector3d& axis) {
  const auto [sin, cos] = portable::sin_cos(0.5 * angle);
  return {cos, sin * axis.x(), sin * axis.y(), sin * axis.z()};
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  if (theta < kSmallAngle) {
    const Eigen::Matrix3d W = skew(phi);
    return Eigen::Quaterniond(Eigen::Matrix3d::Identity() + W + 0.5 * W * W).normalized().toRotationMatrix();
  }
  const auto [sin, cos] = portable::sin_cos(theta);
  const Eigen::Vector3d axis = phi / theta;
  return cos * Eigen::Matrix3d::Identity() + sin * skew(axis) + (1.0 - cos) * axis * axis.transpose();
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  if (n < kSmallAngle) return 2.0 * q.vec() / q.w();
  return 2.0 * portable::atan2(n, q.w()) / n * q.vec();
}

Pose se3_exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return make_pose(so3_exp(phi), Eigen::Vector3d(left_jacobian(phi) * xi.head<3>()));
}

Vector6d se3_log(const Pose& T) {
  Vector6d xi;
  xi.tail<3>() = so3_log(T.linear());
  xi.head<3>() = left_jacobian(xi.tail<3>()).inverse() * T.translation();
  return xi;
}

Matrix6d adjoint(const Pose& T) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = T.linear();
  Ad.bottomRightCorner<3, 3>() = T.linear();
  Ad.topRightCorner<3, 3>() = skew(T.translation()) * T.linear();
  return Ad;
}

Pose interpolate(const Pose& T_w_a, const Pose& T_w_b, double alpha) {
  const Eigen::Vector3d phi = so3_log(T_w_a.linear().transpose() * T_w_b.linear());
  return make_pose(Eigen::Matrix3d(T_w_a.linear() * so3_exp(alpha * phi)),
                   Eigen::Vector3d((1.0 - alpha) * T_w_a.translation() + alpha * T_w_b.translation()));
}

Pose make_pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  Pose T = Pose::Identity();
  T.linear() = R;
  T.translation() = t;
  return T;
}

Pose make_pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) {
  return make_pose(q.normalized().toRotationMatrix(), t);
}

Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw) {
  return (turn(yaw, Eigen::Vector3d::UnitZ()) * turn(pitch, Eigen::Vector3d::UnitY()) *
          turn(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  return {portable::atan2(R(2, 1), R(2, 2)),
          portable::atan2(-R(2, 0), std::sqrt(R(2, 1) * R(2, 1) + R(2, 2) * R(2, 2))),
          portable::atan2(R(1, 0), R(0, 0))};
}

Eigen::Quaterniond minimal_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const auto has_direction = [](const Eigen::Vector3d& v) { return v.allFinite() && v.norm() >= 1e-9; };
  if (!has_direction(from) || !has_direction(to)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Matrix3d levelling(const Eigen::Vector3d& up) {
  return minimal_rotation(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

double wrap_angle(double radians) {
  const double wrapped = std::remainder(radians, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

bool all_finite(const Pose& T) { return T.matrix().allFinite(); }

}  // namespace fleetmap
