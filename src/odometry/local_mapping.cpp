#include "local_mapping.hpp"

#include <span>

#include "deskew.hpp"

namespace fleetmap::odometry {
namespace {

constexpr int kFirstInsertions = 6;    // scans that enter a new map at once, moving or not
constexpr double kPruneEvery = 0.2;    // of the LiDAR's range, driven
constexpr double kShrinkFactor = 0.8;  // of the radius of a full map, repeated until ...
constexpr double kShrinkTo = 0.75;     // ... this share of max_map_windows remains

}  // namespace

bool LocalMapping::is_keyframe(const Pose& T_odom_base) const {
  const Pose moved = keyframe_.inverse() * T_odom_base;
  return moved.translation().norm() > config_.keyframe_distance ||
         so3_log(moved.linear()).norm() > config_.keyframe_angle || insertions_ < kFirstInsertions;
}

void LocalMapping::insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                          const MotionState& state) {
  const SweepMotion motion(state.twist, state.turn_acceleration);
  auto in_odom = [&](const std::vector<FeaturePoint>& features) -> std::span<const Eigen::Vector3d> {
    in_odom_.clear();
    for (const FeaturePoint& p : features) {
      in_odom_.emplace_back(state.T_odom_base * motion.at_reference(p.position, p.time).cast<double>());
    }
    return in_odom_;
  };
  map_.add_surfaces(in_odom(planes), state.T_odom_base * config_.T_base_lidar.translation());
  map_.add_edges(in_odom(edges));
  keyframe_ = state.T_odom_base;
  ++insertions_;
  prune();
}

void LocalMapping::restart() {
  map_.clear();
  insertions_ = 0;
}

void LocalMapping::prune() {
  if ((keyframe_.translation() - pruned_at_.translation()).norm() > kPruneEvery * config_.max_range) {
    map_.prune(keyframe_.translation(), config_.map_radius);
    pruned_at_ = keyframe_;
  }
  const auto max_windows = static_cast<std::size_t>(config_.max_map_windows);
  if (map_.size().windows <= max_windows) return;
  ++overflows_;
  double radius = config_.map_radius;
  while (static_cast<double>(map_.size().windows) > kShrinkTo * static_cast<double>(max_windows)) {
    radius *= kShrinkFactor;
    map_.prune(keyframe_.translation(), radius);
  }
}

}  // namespace fleetmap::odometry
