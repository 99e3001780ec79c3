#include "fleetmap/agent/loop_closures.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap::agent {
namespace {

constexpr double kJustLeft = 40.0;  // m of path

/// Whether a node so far away is where the robot has just come from, straight on or around one corner.
bool just_left(double path, double distance) { return path <= std::max(kJustLeft, 1.5 * distance); }

}  // namespace

Status LoopClosureConfig::validate() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(reach)) return failure("loop_closures.reach must be > 0 m");
  if (!(std::isfinite(min_path) && min_path >= 2.0 * reach)) {
    return failure("loop_closures.min_path must be at least twice the reach");
  }
  if (!(std::isfinite(spacing) && spacing >= 0.0)) return failure("loop_closures.spacing must be >= 0 m");
  return {};
}

std::optional<LoopClosure> LoopClosures::on_own_node(const graph::Node& node) {
  if (!nodes_.empty() && nodes_.front().frame() != node.frame()) {
    nodes_.clear();
    path_.clear();
    last_closure_.reset();
  }
  const double step = nodes_.empty()
                          ? 0.0
                          : (node.T_odom_base.translation() - nodes_.back().T_odom_base.translation()).norm();
  path_.push_back(path_.empty() ? 0.0 : path_.back() + step);
  nodes_.push_back(node);

  if (nodes_.size() <= config_.ripe_nodes) return std::nullopt;
  const std::size_t later = nodes_.size() - 1 - config_.ripe_nodes;
  if (last_closure_ && path_[later] - *last_closure_ < config_.spacing) return std::nullopt;
  const auto earlier = nearest_earlier(later);
  if (!earlier) return std::nullopt;
  last_closure_ = path_[later];
  return LoopClosure{nodes_[*earlier], nodes_[later], covariance_between(*earlier, later)};
}

std::optional<std::size_t> LoopClosures::nearest_earlier(std::size_t later) const {
  std::optional<std::size_t> nearest;
  double distance = config_.reach;
  const Eigen::Vector3d place = nodes_[later].T_odom_base.translation();
  for (std::size_t k = 0; k < later; ++k) {
    const double d = (nodes_[k].T_odom_base.translation() - place).norm();
    if (d > distance || just_left(path_[later] - path_[k], d)) continue;
    distance = d;
    nearest = k;
  }
  // Behind a bend the nearest one is still too fresh; farther ones are no better for being older.
  if (nearest && path_[later] - path_[*nearest] < config_.min_path) return std::nullopt;
  return nearest;
}

Matrix6d LoopClosures::covariance_between(std::size_t earlier, std::size_t later) const {
  UncertainPose T_earlier_here;
  for (std::size_t k = earlier + 1; k <= later; ++k) {
    T_earlier_here = compose(T_earlier_here, {nodes_[k - 1].T_odom_base.inverse() * nodes_[k].T_odom_base,
                                              nodes_[k].odom_covariance});
  }
  return T_earlier_here.covariance;
}

}  // namespace fleetmap::agent
