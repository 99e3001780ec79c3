#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fleetmap::registration {

/// A piece of surface, edge or clutter: the points of 3 x 3 x 3 voxels, as their mean and what they say of a
/// point near them: one direction across a plane, two across a post, three in clutter, none in a speck. One
/// line of the cache.
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

struct SurfelConfig {
  float voxel_m = 0.35f;     ///< m
  float noise_m = 0.03f;     ///< m, of a point, added to the spread
  float extended_m = 0.15f;  ///< m, a larger spread along an axis is extent, not uncertainty
  int min_points = 4;
  float sparse_voxel_m =
      1.75f;  ///< m, where points lie too wide apart for surfels of `voxel_m`: thinned ground
  float hidden_depth_m = 0.12f;  ///< m, how far the middle of a post may lie behind the side that was seen
};

/// Surfels of a cloud, one for each voxel that holds points and has enough around it, larger ones through the
/// lowest points where they lie wide apart, and, for every place near them, which is nearest. Points must be
/// finite and within some 100 m of the origin.
class SurfelMap {
 public:
  SurfelMap() = default;
  SurfelMap(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);

  static constexpr std::uint16_t kNone = 0xffff;
  static constexpr std::size_t kBlock =
      64;  ///< points looked up together: most of the time memory is waited for
  enum class Reach { near, far };
  /// Of each of up to kBlock points: the nearest surfel, as seen from the middle of a small cell around it,
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
    /// Of the surfels from `first` on.
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
