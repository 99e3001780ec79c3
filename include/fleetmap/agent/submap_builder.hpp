#pragma once

#include <cstddef>
#include <optional>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::agent {

struct SubmapConfig {
  double voxel = 0.1;                  ///< m, points are thinned to one a cube of this edge
  double resolution = 0.02;            ///< m, rounding of the encoded points
  double scan_spacing = 0.2;           ///< m of motion between scans that enter a submap
  double scan_angle = 0.1;             ///< rad of turn between scans that enter a submap
  std::uint32_t max_bytes = 4u << 20;  ///< of one encoded submap; thinned more coarsely until it fits
  Status validate() const;
};

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
