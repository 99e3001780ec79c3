#pragma once

#include <cstddef>
#include <optional>

#include "fleetmap/agent/submap_config.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

/// Gathers the points seen since the last node and freezes them into that node's submap.
class SubmapBuilder {
 public:
  /// `config` must be valid.
  explicit SubmapBuilder(const SubmapConfig& config);

  /// Points of one de-skewed scan, in base_link at `T_odom_base`. Scans from almost the same place are left
  /// out.
  void add(const cloud::PointCloud& points, const Pose& T_odom_base);

  struct Frozen {
    Bytes encoded;
    std::size_t points = 0;
    double voxel = 0.0;  ///< m, that it was thinned to
  };
  /// The submap in base_link of the node at `T_odom_node`. It goes on growing until clear().
  Result<Frozen> freeze(const Pose& T_odom_node) const;
  /// Begins the next submap.
  void clear();

  /// The merged points, in the odometry frame.
  cloud::PointCloud cloud() const { return merger_.cloud(); }
  std::size_t points() const { return merger_.voxels(); }
  std::size_t refused_points() const { return refused_points_; }

 private:
  bool moved_enough(const Pose& T_odom_base) const;

  SubmapConfig config_;
  cloud::VoxelMerger merger_;  ///< in the odometry frame
  std::optional<Pose> T_odom_last_scan_;
  std::size_t refused_points_ = 0;
};

}  // namespace fleetmap::agent
