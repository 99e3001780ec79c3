#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration {

/// Prior of the relative pose, from both robots' G or from another source.
struct Prior {
  Pose T_target_source = Pose::Identity();
  double sigma_translation_m = 5.0;  ///< m, per horizontal axis
  double sigma_yaw_rad = 0.2;        ///< rad, about the target's z axis
  double sigma_tilt_rad = 0.1;       ///< rad, about each of its x and y axes
  double sigma_height_m = 10.0;      ///< m, along the vertical
  /// Against gravity, in the target's frame (any length).
  Eigen::Vector3d up_target = Eigen::Vector3d::UnitZ();
  Status validate() const;
};

/// Whether `T_target_source` lies within `sigmas` of the prior: horizontally (norm), in height, yaw and tilt.
bool agrees(const Prior& prior, const Pose& T_target_source, double sigmas);

}  // namespace fleetmap::registration
