#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/drivable_config.hpp"
#include "fleetmap/sim/mesh.hpp"
#include "fleetmap/sim/site_drawing.hpp"

namespace fleetmap::sim {

/// Horizontal rectangle in the world's ENU frame, m.
struct WorldBounds {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  bool contains(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// A site that robots drive on: its mesh, the ground under them and what is in the way. Immutable; shared by
/// threads without locks.
class World {
 public:
  /// From any mesh. The ground at (x, y) is the lowest surface there that is no wall, with what lies on it up
  /// to a step high; holes narrower than a metre are bridged, wider ones are in the way. Fails, with the
  /// remedy, for a mesh without triangles, with non-finite vertices, too large for its cells, or with hardly
  /// any ground that can be driven on.
  /// A drawing without a boundary gets the bounds of the mesh.
  static Result<std::shared_ptr<const World>> create(Mesh mesh, const DrivableConfig& config = {},
                                                     SiteDrawing drawing = {});

  const Mesh& mesh() const { return mesh_; }
  const WorldBounds& bounds() const { return bounds_; }
  /// Lanes to map along, sorted across the site; empty for a user's mesh.
  const std::vector<Aisle>& aisles() const { return drawing_.lanes; }
  /// The drawing that a user has of this site before a robot was there, without an error in position.
  const SiteDrawing& drawing() const { return drawing_; }
  const DrivableConfig& drivable() const { return config_; }
  /// Share of the bounds' cells where nothing is in the way.
  double drivable_share() const { return drivable_share_; }
  /// m above the origin, bilinear between cells; outside the bounds that of the nearest cell.
  double ground_height(const Eigen::Vector2d& p) const;
  /// Upward unit normal of the ground, smoothed over about a robot's length.
  Eigen::Vector3d ground_normal(const Eigen::Vector2d& p) const;
  /// True if a robot of this radius (m) at `p` would touch an obstacle, or `p` is outside the world.
  bool blocked(const Eigen::Vector2d& p, double radius) const;
  /// m, from `p` to the nearest cell in the way, at most `limit`.
  double clearance(const Eigen::Vector2d& p, double limit) const;

 private:
  World() = default;
  Mesh mesh_;
  WorldBounds bounds_;
  SiteDrawing drawing_;
  DrivableConfig config_;
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();  ///< cells along east and north
  std::vector<float> heights_;                      ///< row by row from the south
  std::vector<std::uint8_t> blocked_;
  double drivable_share_ = 0.0;
};

}  // namespace fleetmap::sim
