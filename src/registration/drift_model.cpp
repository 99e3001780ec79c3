#include "drift_model.hpp"

#include <algorithm>

namespace fleetmap::registration {
namespace {

/// m; a robot that passes a surface sees it most from within about this distance: farther off its rays lie
/// too wide apart to hit each voxel.
constexpr double kObservingRange = 6.0;

}  // namespace

DriftModel::DriftModel(const MapDrift& drift, const Eigen::Matrix3d& R_level_cloud) {
  const std::vector<MapStop> assumed =
      drift.stops.empty() ? MapDrift::straight().stops : std::vector<MapStop>{};
  const std::vector<MapStop>& stops = drift.stops.empty() ? assumed : drift.stops;
  const Pose T_level_cloud = make_pose(R_level_cloud, Eigen::Vector3d::Zero());
  double nearest = stops.front().T_cloud_base.translation().squaredNorm();
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const Pose T_level_base = T_level_cloud * stops[k].T_cloud_base;
    stops_.push_back(T_level_base.translation().head<2>());
    const double distance = T_level_base.translation().squaredNorm();
    if (distance < nearest) nearest = distance, fixed_ = k;
    if (k == 0) continue;
    const Matrix6d Ad = adjoint(T_level_base);
    deformations_.push_back(Ad * stops[k].step_covariance * Ad.transpose());
  }
}

void DriftModel::shares_beyond(const Eigen::Vector2d& center, std::vector<double>& shares) const {
  double all = 0.0;
  const auto weight = [&](std::size_t stop) {
    return 1.0 / (1.0 + (center - stops_[stop]).squaredNorm() / (kObservingRange * kObservingRange));
  };
  shares.assign(deformations_.size(), 0.0);
  double behind = 0.0;
  for (std::size_t k = 0; k < stops_.size(); ++k) {
    behind += weight(k);
    if (k < deformations_.size()) shares[k] = behind;
  }
  all = behind;
  for (std::size_t k = 0; k < shares.size(); ++k)
    shares[k] = k < fixed_ ? shares[k] / all : 1.0 - shares[k] / all;
}

Matrix6d DriftModel::gradient_covariance(const std::vector<PatchInformation>& patches,
                                         const Matrix6d& transport) const {
  std::vector<Matrix6d> beyond(deformations_.size(), Matrix6d::Zero());
  std::vector<double> shares;
  for (const PatchInformation& patch : patches) {
    shares_beyond(patch.center, shares);
    for (std::size_t k = 0; k < shares.size(); ++k) beyond[k] += shares[k] * patch.H;
  }
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t k = 0; k < deformations_.size(); ++k) {
    const Matrix6d pushed = beyond[k] * transport;
    sum += pushed * deformations_[k] * pushed.transpose();
  }
  return sum;
}

}  // namespace fleetmap::registration
