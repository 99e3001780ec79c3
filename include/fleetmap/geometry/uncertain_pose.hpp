#pragma once

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap {

/// A relative pose and how well it is known.
struct UncertainPose {
  Pose T_a_b = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< right tangent of T_a_b: [m, rad]
};

/// T_a_c; the errors of the two are independent.
UncertainPose compose(const UncertainPose& T_a_b, const UncertainPose& T_b_c);
/// T_b_a.
UncertainPose inverse(const UncertainPose& T_a_b);

}  // namespace fleetmap
