#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap {

UncertainPose compose(const UncertainPose& T_a_b, const UncertainPose& T_b_c) {
  const Matrix6d Ad = adjoint(T_b_c.T_a_b.inverse());
  return {T_a_b.T_a_b * T_b_c.T_a_b, Ad * T_a_b.covariance * Ad.transpose() + T_b_c.covariance};
}

UncertainPose inverse(const UncertainPose& T_a_b) {
  const Matrix6d Ad = adjoint(T_a_b.T_a_b);
  return {T_a_b.T_a_b.inverse(), Ad * T_a_b.covariance * Ad.transpose()};
}

}  // namespace fleetmap
