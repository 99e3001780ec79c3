#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace fleetmap::registration {

/// A piece of surface, edge or clutter: the points of 3 x 3 x 3 voxels, as their mean and what they say of a
/// point near them. A direction of weight 0 says nothing (within a plane, along a post).
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  std::array<Eigen::Vector3f, 3> axes;    ///< unit; ascending spread
  std::array<float, 3> weights{0, 0, 0};  ///< 1/m^2, inverse variance along each axis
  bool planar = false;                    ///< axes[0] is a normal
  float side = 0.0f;  ///< m, how far the sensor was on the side that axes[0] points to; negative behind
};

struct SurfelConfig {
  float voxel_m = 0.35f;     ///< m
  float noise_m = 0.03f;     ///< m, of a point, added to the spread
  float extended_m = 0.15f;  ///< m, a larger spread along an axis is extent, not uncertainty
  int min_points = 4;
  float sparse_voxel_m =
      1.75f;  ///< m, where points lie too wide apart for surfels of `voxel_m`: thinned ground
  /// m, about how high over the cloud's origin the sensor passed, along the x axis as robots drive.
  float sensor_height_m = 0.35f;
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
  /// The nearest surfel, as seen from the middle of a small cell around p, within about a voxel.
  const Surfel* near(const Eigen::Vector3f& p) const {
    const Surfel* surfel = fine_.at(p, surfels_);
    return surfel != nullptr ? surfel : sparse_.at(p, surfels_);
  }
  /// The same within about three voxels.
  const Surfel* far(const Eigen::Vector3f& p) const {
    const Surfel* surfel = coarse_.at(p, surfels_);
    return surfel != nullptr ? surfel : sparse_.at(p, surfels_);
  }
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
    void build(const std::vector<Surfel>& surfels, std::size_t first, float cell_m, int reach);
    const Surfel* at(const Eigen::Vector3f& p, const std::vector<Surfel>& surfels) const {
      const Eigen::Vector3f g = (p - origin) * inverse_cell;
      if (!(g.x() >= 0.0f && g.y() >= 0.0f && g.z() >= 0.0f)) return nullptr;
      if (!(g.x() < static_cast<float>(size.x()) && g.y() < static_cast<float>(size.y()) &&
            g.z() < static_cast<float>(size.z())))
        return nullptr;
      const std::uint16_t index =
          cells[(static_cast<std::size_t>(g.z()) * static_cast<std::size_t>(size.y()) +
                 static_cast<std::size_t>(g.y())) *
                    static_cast<std::size_t>(size.x()) +
                static_cast<std::size_t>(g.x())];
      return index == kNone ? nullptr : &surfels[index];
    }
  };
  void add_fine(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);
  void add_sparse(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config);

  std::vector<Surfel> surfels_;
  std::vector<std::uint16_t> of_points_;
  Lookup fine_, coarse_, sparse_;
};

}  // namespace fleetmap::registration
