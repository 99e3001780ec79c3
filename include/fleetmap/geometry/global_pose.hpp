#pragma once

#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap {

/// G_i(t) of the paper: where base_link is on Earth, from the EKF.
struct GlobalPose {
  Stamp stamp;
  GeoPoint position;  ///< of base_link
  /// Rotation from base_link to the ENU axes at `position`.
  Eigen::Quaterniond q_enu_base = Eigen::Quaterniond::Identity();
  /// Covariance of [position error in ENU (m), rotation error in ENU axes (rad)].
  Matrix6d covariance = Matrix6d::Identity();
};

/// T_enu_base in the given site frame.
Pose pose_in(const LocalFrame& frame, const GlobalPose& G);

}  // namespace fleetmap
