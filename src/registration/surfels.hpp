#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surfel_config.hpp"

namespace fleetmap::registration {

/// A piece of surface, edge or clutter: the points of 3 x 3 x 3 voxels, as their mean and the directions in
/// which they constrain a point near them: one across a plane, two across a post, three in clutter, none in
/// a speck. Fits one cache line.
struct alignas(64) Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  std::array<Eigen::Vector3f, 2> axes;  ///< unit, of the first two directions; the third is across both
  std::array<float, 2> weights{0,
                               0};  ///< 1/m^2, inverse variance along them; the third has that of the first
  /// m, how far the sensor was on the side that the normal of a plane, or axes[1] of a post, points to;
  /// negative behind.
  float side = 0.0f;
  std::uint8_t directions = 0;
  bool planar = false;  ///< axes[0] is a normal
};

/// m, about how high over the cloud's origin the sensor passed.
constexpr float kSensorHeight = 0.35f;
/// About where the sensor was when it saw a point: beside it on the x axis, along which robots drive.
inline Eigen::Vector3f sensor_beside(const Eigen::Vector3f& point) {
  return {point.x(), 0.0f, kSensorHeight};
}

/// Surfels of a cloud, one for each voxel that holds points and has enough around it, larger ones through the
/// lowest points where they lie wide apart, and, for every place near them, which is nearest. Points must be
/// finite and within some 100 m of the origin.
class SurfelMap {
 public:
  SurfelMap() = default;
  SurfelMap(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);

  static constexpr std::uint16_t kNone = 0xffff;
  static constexpr std::size_t kBlock =
      64;  ///< points whose cells are fetched together: the lookup is bound by memory latency
  enum class Reach { near, far };
  /// Finds the nearest surfel of up to kBlock points, as seen from the middle of a small cell around each,
  /// within about a voxel (near) or three (far); null where there is none.
  void find(std::span<const Eigen::Vector3f> points, Reach reach, const Surfel** found) const;
  const std::vector<Surfel>& surfels() const { return surfels_; }
  /// Surfel of each point's own voxel, kNone where it has none.
  const std::vector<std::uint16_t>& of_points() const { return of_points_; }

 private:
  /// Index of the nearest surfel for each cell of a box.
  struct Lookup {
    float inverse_cell = 0.0f;
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();
    Eigen::Vector3i size = Eigen::Vector3i::Zero();
    std::vector<std::uint16_t> cells;
    /// Builds the grid of the surfels from `first` on.
    void build(const std::vector<Surfel>& surfels, std::size_t first, float cell_m);
    /// Index into `cells`, -1 outside.
    std::ptrdiff_t cell_of(const Eigen::Vector3f& p) const {
      const Eigen::Vector3f g = (p - origin) * inverse_cell;
      if (!(g.x() >= 0.0f && g.y() >= 0.0f && g.z() >= 0.0f)) return -1;
      if (!(g.x() < static_cast<float>(size.x()) && g.y() < static_cast<float>(size.y()) &&
            g.z() < static_cast<float>(size.z())))
        return -1;
      return (static_cast<std::ptrdiff_t>(g.z()) * size.y() + static_cast<std::ptrdiff_t>(g.y())) * size.x() +
             static_cast<std::ptrdiff_t>(g.x());
    }
  };
  void add_fine(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);
  void add_sparse(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);

  std::vector<Surfel> surfels_;
  std::vector<std::uint16_t> of_points_;
  Lookup fine_, coarse_, sparse_;
};

}  // namespace fleetmap::registration
