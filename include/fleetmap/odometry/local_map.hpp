#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/surface_grid.hpp"
#include "fleetmap/odometry/thinning.hpp"

namespace fleetmap::odometry {

/// Size of a local map.
struct LocalMapSize {
  std::size_t windows = 0;  ///< of all grids
  std::size_t bytes = 0;
};

/// Local map around the robot: surfaces at two scales, upright posts among them, and edges.
class LocalMap {
 public:
  explicit LocalMap(const LoamConfig& config);

  /// `sensor`: where the points were seen from.
  void add_surfaces(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& sensor);
  void add_edges(std::span<const Eigen::Vector3d> points);
  /// Makes surface_at() at these points, some dozens, faster.
  void fetch_ahead(std::span<const Eigen::Vector3d> points) const { fine_.fetch_ahead(points); }
  /// Within one cell surface_at() finds the same plane, if it finds one.
  CellKey cell_of(const Eigen::Vector3d& point) const { return fine_.cell_at(point); }
  /// A plane or upright line near `point`: from the finer windows where they hold enough points, else from
  /// the coarser ones; null where there is none.
  const Surface* surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor);
  /// An edge near `point`, or null.
  const Surface* edge_at(const Eigen::Vector3d& point);
  void prune(const Eigen::Vector3d& center, double radius);
  void clear();
  LocalMapSize size() const;
  bool empty() const { return coarse_.size() == 0; }

 private:
  SurfaceGrid fine_, coarse_, posts_, edges_;
  Thinning coarse_thinning_;
  std::vector<SurfaceGrid::ObservedPoint> observed_, thin_;  ///< keep their memory between calls
};

}  // namespace fleetmap::odometry
