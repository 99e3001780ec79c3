#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "features.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/local_map.hpp"
#include "motion_prior.hpp"

namespace fleetmap::odometry {

/// Builds the local map from keyframes and bounds its size.
class LocalMapping {
 public:
  explicit LocalMapping(const LoamConfig& config) : config_(config), map_(config) {}

  /// True if a scan at this pose is a keyframe: far enough from the last one, or among the map's first.
  bool is_keyframe(const Pose& T_odom_base) const;
  /// Adds the features of a scan, motion compensated by `state`.
  void insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
              const MotionState& state);
  /// Removes all surfaces and edges; the keyframe stays, and so does the count of first scans.
  void clear() { map_.clear(); }
  /// Begins a new local map, whose first scans are all keyframes.
  void restart();

  LocalMap& map() { return map_; }
  LocalMapSize size() const { return map_.size(); }
  /// Counts each time that the map was full, so that its farthest windows were removed.
  std::uint64_t overflows() const { return overflows_; }

 private:
  void prune();

  LoamConfig config_;
  LocalMap map_;
  Pose keyframe_ = Pose::Identity(), pruned_at_ = Pose::Identity();
  int insertions_ = 0;  ///< into this local map
  std::uint64_t overflows_ = 0;
  std::vector<Eigen::Vector3d> in_odom_;  ///< keeps its memory between scans
};

}  // namespace fleetmap::odometry
