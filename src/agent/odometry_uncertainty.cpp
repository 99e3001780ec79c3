#include "fleetmap/agent/odometry_uncertainty.hpp"

namespace fleetmap::agent {

Status OdometryUncertaintyConfig::validate() const {
  if (!(translation_share >= 0.0) || !(rotation_rad_per_m >= 0.0)) {
    return failure("odometry_uncertainty.translation_share and rotation_rad_per_m must not be negative");
  }
  if (!(translation_floor_m > 0.0) || !(rotation_floor_rad > 0.0)) {
    return failure("odometry_uncertainty.translation_floor_m and rotation_floor_rad must be positive");
  }
  return {};
}

Matrix6d odometry_covariance(const Pose& T_previous_this, const OdometryUncertaintyConfig& config) {
  const double distance = T_previous_this.translation().norm();
  const double translation = config.translation_floor_m + config.translation_share * distance;
  const double rotation = config.rotation_floor_rad + config.rotation_rad_per_m * distance;
  Vector6d stddev;
  stddev << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return stddev.cwiseAbs2().asDiagonal();
}

}  // namespace fleetmap::agent
