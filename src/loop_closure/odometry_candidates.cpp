#include "odometry_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap::loop_closure {
namespace {

constexpr double kMinPath = 40.0;  // m of path

/// Whether a node `distance` away is on the path just driven, straight or around one corner.
bool just_left(double path, double distance) { return path <= std::max(kMinPath, 1.5 * distance); }

}  // namespace

std::optional<LoopCandidate> OdometryCandidates::propose(const graph::Node& node) {
  if (frame_ != node.frame()) {
    frame_ = node.frame();
    steps_.clear();
    positions_.clear();
    path_.clear();
    last_on_path_.reset();
  }
  const Eigen::Vector3d position = node.T_odom_base.translation();
  path_.push_back(path_.empty() ? 0.0 : path_.back() + (position - positions_.back()).norm());
  positions_.push_back(position);
  steps_.push_back({node.id, node.T_odom_base, node.odom_covariance});

  if (steps_.size() <= config_.min_nodes_after) return std::nullopt;
  const std::size_t later = steps_.size() - 1 - config_.min_nodes_after;
  if (last_on_path_ && path_[later] - *last_on_path_ < config_.spacing) return std::nullopt;
  const auto earlier = nearest_earlier(later);
  if (!earlier) return std::nullopt;
  last_on_path_ = path_[later];
  LoopCandidate candidate{steps_[*earlier].id, steps_[later].id, LoopCandidate::Origin::kOdometry};
  candidate.T_target_source = odometry(*earlier, later);
  candidate.distance = candidate.T_target_source->T_a_b.translation().norm();
  candidate.radius = config_.reach;
  return candidate;
}

std::optional<std::size_t> OdometryCandidates::nearest_earlier(std::size_t later) const {
  std::optional<std::size_t> nearest;
  double distance = config_.reach;
  for (std::size_t k = 0; k < later; ++k) {
    const double d = (positions_[k] - positions_[later]).norm();
    if (d > distance || just_left(path_[later] - path_[k], d)) continue;
    distance = d;
    nearest = k;
  }
  // Behind a bend the nearest node is too recent; a farther one is no better for being older.
  if (nearest && path_[later] - path_[*nearest] < config_.min_path) return std::nullopt;
  return nearest;
}

UncertainPose OdometryCandidates::odometry(std::size_t earlier, std::size_t later) const {
  UncertainPose T_earlier_here;
  for (std::size_t k = earlier + 1; k <= later; ++k) {
    T_earlier_here = compose(T_earlier_here, {steps_[k - 1].T_odom_base.inverse() * steps_[k].T_odom_base,
                                              steps_[k].odom_covariance});
  }
  // Without the rounding errors of the way.
  return {steps_[earlier].T_odom_base.inverse() * steps_[later].T_odom_base, T_earlier_here.covariance};
}

}  // namespace fleetmap::loop_closure
