#pragma once

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap {

/// A covariance of [m, rad] in the axes of frame b, in those of frame a.
inline Matrix6d rotated(const Matrix6d& covariance_b, const Eigen::Matrix3d& R_a_b) {
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = R_a_b;
  return R * covariance_b * R.transpose();
}

}  // namespace fleetmap
