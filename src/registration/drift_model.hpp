#pragma once

#include <Eigen/Core>
#include <vector>

#include "fleetmap/registration/map_drift.hpp"

namespace fleetmap::registration {

/// The points of one square of ground as a constraint of the pose: their share of the normal equations.
struct PatchInformation {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< m, in the frame of the distorted cloud
  Matrix6d H = Matrix6d::Zero();
};

/// The drift of a map as independent deformations of its levelled cloud: deformation k rotates and shifts
/// everything that was seen from beyond the step between stops k and k + 1, relative to the stop to which the
/// cloud's frame is fixed.
class DriftModel {
 public:
  DriftModel() = default;
  DriftModel(const MapDrift& drift, const Eigen::Matrix3d& R_level_cloud);

  /// Covariance of the gradient sum_i J_i^T w_i r_i of an alignment whose residuals r_i the deformations
  /// change: a twist eta of the points of a patch changes its gradient by H T eta, where `transport` T takes
  /// twists of this cloud's levelled frame to those that H is about.
  Matrix6d gradient_covariance(const std::vector<PatchInformation>& patches, const Matrix6d& transport) const;

 private:
  /// For each deformation, the share of a patch's points that were seen from beyond it.
  void shares_beyond(const Eigen::Vector2d& center, std::vector<double>& shares) const;

  std::vector<Eigen::Vector2d> stops_;
  std::vector<Matrix6d> deformations_;  ///< covariance of a deformation as a twist about the cloud's origin
  std::size_t fixed_ = 0;               ///< stop to which the frame is fixed
};

}  // namespace fleetmap::registration
