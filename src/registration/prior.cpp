#include "fleetmap/registration/prior.hpp"

#include <cmath>

namespace fleetmap::registration {

Status Prior::validate() const {
  if (!all_finite(T_target_source)) return failure("prior pose must be finite");
  if (!(sigma_translation_m > 0.0)) return failure("prior sigma_translation_m must be positive");
  if (!(sigma_yaw_rad > 0.0)) return failure("prior sigma_yaw_rad must be positive");
  if (!(sigma_tilt_rad > 0.0)) return failure("prior sigma_tilt_rad must be positive");
  return {};
}

bool agrees(const Prior& prior, const Pose& T_target_source, double sigmas) {
  const Eigen::Vector3d dt = T_target_source.translation() - prior.T_target_source.translation();
  const Eigen::Matrix3d dR = T_target_source.linear() * prior.T_target_source.linear().transpose();
  const double yaw = std::atan2(dR(1, 0) - dR(0, 1), dR(0, 0) + dR(1, 1));
  const double tilt = std::acos(std::fmin(1.0, std::fmax(-1.0, dR(2, 2))));
  return dt.norm() <= sigmas * prior.sigma_translation_m && std::abs(yaw) <= sigmas * prior.sigma_yaw_rad &&
         tilt <= sigmas * prior.sigma_tilt_rad;
}

}  // namespace fleetmap::registration
