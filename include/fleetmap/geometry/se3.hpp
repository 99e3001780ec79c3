#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fleetmap {

/// Rigid transform. Always named T_a_b: maps points of frame b into frame a.
using Pose = Eigen::Isometry3d;
/// Tangent vector of SE(3), translation first: [rho (m), phi (rad)].
using Vector6d = Eigen::Matrix<double, 6, 1>;
/// Covariance or information of a Vector6d, same order.
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Exponential and logarithm of SO(3): rotation vector in radians, |log| <= pi.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi);
Eigen::Vector3d so3_log(const Eigen::Matrix3d& R);

/// Exponential and logarithm of SE(3) in the order of Vector6d.
Pose se3_exp(const Vector6d& xi);
Vector6d se3_log(const Pose& T);

/// Adjoint: T exp(xi) T^-1 = exp(Ad_T xi).
Matrix6d adjoint(const Pose& T);

/// Translation linear, rotation slerp; alpha 0 is T_w_a, 1 is T_w_b; alpha outside [0, 1] extrapolates.
Pose interpolate(const Pose& T_w_a, const Pose& T_w_b, double alpha);

Pose make_pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t);
Pose make_pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t);

/// Rz(yaw) Ry(pitch) Rx(roll), radians.
Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw);
/// Inverse of rotation_from_rpy: (roll, pitch, yaw), radians.
Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);
/// The minimal rotation that turns `from` into the direction of `to`, of any lengths. Identity where one of
/// them is zero or not finite.
Eigen::Quaterniond minimal_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
/// The minimal rotation that turns `up` to z: a frame to its level frame.
Eigen::Matrix3d levelling(const Eigen::Vector3d& up);
/// Wraps to (-pi, pi].
double wrap_angle(double radians);

bool all_finite(const Pose& T);

}  // namespace fleetmap
