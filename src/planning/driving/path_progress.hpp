#pragma once

#include <Eigen/Core>
#include <vector>

#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Position of a robot along its path. It never jumps past a corner that is not reached yet, so a path may
/// run back beside itself.
class PathProgress {
 public:
  PathProgress() = default;
  explicit PathProgress(const Polyline& path);

  bool empty() const { return points_.size() < 2; }
  double length() const { return empty() ? 0.0 : at_.back(); }
  double along() const { return along_; }  ///< m
  /// Moves on to the place beside `p`; corners within `tolerance`, or passed within `abeam` (m), are reached.
  void advance(const Eigen::Vector2d& p, double tolerance, double abeam);
  /// The next corner (or the end) counts as reached.
  void skip_corner() { along_ = next_corner(); }
  /// m along the path to the next sharp corner, or its end.
  double next_corner() const;
  Eigen::Vector2d point(double along) const;
  Eigen::Vector2d tangent(double along) const;  ///< unit

 private:
  std::size_t segment(double along) const;
  Polyline points_;
  std::vector<double> at_;       // m, of each point
  std::vector<double> corners_;  // m, of sharp corners and the end
  double along_ = 0.0;
};

}  // namespace fleetmap::planning
