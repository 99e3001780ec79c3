#include "fleetmap/registration/prior.hpp"

#include <cmath>

namespace fleetmap::registration {

Status Prior::validate() const {
  if (!all_finite(T_target_source)) return failure("prior pose must be finite");
  if (!(sigma_translation_m > 0.0)) return failure("prior sigma_translation_m must be positive");
  if (!(sigma_yaw_rad > 0.0)) return failure("prior sigma_yaw_rad must be positive");
  if (!(sigma_tilt_rad > 0.0)) return failure("prior sigma_tilt_rad must be positive");
  if (!(sigma_height_m > 0.0)) return failure("prior sigma_height_m must be positive");
  if (!up_target.allFinite() || !(up_target.norm() > 1e-6))
    return failure("prior up_target must be a finite vector other than zero");
  return {};
}

bool agrees(const Prior& prior, const Pose& T_target_source, double sigmas) {
  const Eigen::Matrix3d R_level_target = levelling(prior.up_target);
  const Eigen::Vector3d dt =
      R_level_target * (T_target_source.translation() - prior.T_target_source.translation());
  const Eigen::Matrix3d dR = R_level_target * T_target_source.linear() *
                             prior.T_target_source.linear().transpose() * R_level_target.transpose();
  const double yaw = std::atan2(dR(1, 0) - dR(0, 1), dR(0, 0) + dR(1, 1));
  const double tilt = std::acos(std::fmin(1.0, std::fmax(-1.0, dR(2, 2))));
  return dt.head<2>().norm() <= sigmas * prior.sigma_translation_m &&
         std::abs(dt.z()) <= sigmas * prior.sigma_height_m && std::abs(yaw) <= sigmas * prior.sigma_yaw_rad &&
         tilt <= sigmas * prior.sigma_tilt_rad;
}

}  // namespace fleetmap::registration
