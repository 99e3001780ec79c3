#include "item_rules.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace fleetmap::store {
namespace {

/// Symmetric, without negative eigenvalues, and of a size that a place on Earth can have.
bool is_covariance(const Matrix6d& C) {
  constexpr double kMaxEntry = 1e15;  // m^2 or rad^2
  return C.allFinite() && C.cwiseAbs().maxCoeff() <= kMaxEntry && C == C.transpose() && C.ldlt().isPositive();
}

/// A rotation, to rounding, and a distance.
bool is_pose(const Pose& T) {
  constexpr double kMaxDistance = 1e7;  // m
  return all_finite(T) && T.translation().cwiseAbs().maxCoeff() <= kMaxDistance &&
         (T.linear() * T.linear().transpose()).isIdentity(1e-6);
}

bool valid(const graph::AlignmentMode& mode) {
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  return is_pose(mode.T_i_j) && is_covariance(mode.covariance) && mode.rmse >= 0.0 &&
         std::isfinite(mode.rmse) && share(mode.inlier_fraction) && share(mode.score);
}

bool valid(const GlobalPose& G) {
  return is_valid(G.position) && G.q_enu_base.coeffs().allFinite() && G.covariance.allFinite();
}

}  // namespace

bool is_valid(const graph::Node& node, const StoreConfig& config) {
  return !node.id.agent.empty() && node.id.seq < kEndOfSeqs && (!node.G || valid(*node.G)) &&
         node.up_in_base.allFinite() && node.descriptor.size() <= graph::Node::kMaxDescriptorBytes &&
         is_pose(node.T_odom_base) && is_covariance(node.odom_covariance) &&
         node.submap_bytes <= config.max_submap_bytes;
}

bool is_valid(const graph::Alignment& a) {
  return !a.computed_by.empty() && !a.i.agent.empty() && !a.j.agent.empty() && a.i != a.j &&
         (a.computed_by == a.i.agent || a.computed_by == a.j.agent) && a.seq < kEndOfSeqs &&
         a.i.seq < kEndOfSeqs && a.j.seq < kEndOfSeqs && !a.modes.empty() &&
         a.modes.size() <= graph::Alignment::kMaxModes &&
         std::ranges::all_of(a.modes, [](const graph::AlignmentMode& mode) { return valid(mode); });
}

}  // namespace fleetmap::store
