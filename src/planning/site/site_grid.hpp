#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// A site's keep-outs on a raster, so that any polygons, overlapping or not, are tested in the same short
/// time.
class SiteGrid {
 public:
  enum Zone : std::uint8_t {
    kNear = 1,    ///< within the clearance of a keep-out or of the boundary
    kInside = 2,  ///< in a keep-out or outside of the boundary
  };
  /// Covers the mission's boundary, or else all its points and `also` with `margin` (m) around.
  SiteGrid(const Mission& mission, double clearance, double cell, double margin,
           std::span<const Eigen::Vector2d> also);

  /// Ground outside of the raster is kNear and kInside.
  std::uint8_t zone(const Eigen::Vector2d& p) const;
  bool clear(const Eigen::Vector2d& p) const { return zone(p) == 0; }
  /// No cell under the straight line from a to b has any of the zones in `mask`.
  bool line_clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::uint8_t mask) const;
  /// The clear point nearest to p, within `radius` (m); from a p outside of keep-outs without crossing one.
  std::optional<Eigen::Vector2d> nearest_clear(const Eigen::Vector2d& p, double radius) const;

  double cell() const { return cell_; }
  const Eigen::Vector2d& low() const { return low_; }
  Eigen::Vector2d high() const { return low_ + cell_ * Eigen::Vector2d(width_, height_); }

 private:
  void draw_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius, std::uint8_t zone);
  void draw_outline(const KeepOut& polygon, double clearance);
  void fence_in(const KeepOut& boundary, double clearance);
  void fill(const KeepOut& polygon);
  void mark(int y, double x_from, double x_to, std::uint8_t zone);
  double centre(int index, int axis) const { return low_[axis] + (index + 0.5) * cell_; }

  Eigen::Vector2d low_;
  double cell_;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> zones_;
};

}  // namespace fleetmap::planning
