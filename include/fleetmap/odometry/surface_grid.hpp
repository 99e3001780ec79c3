#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "fleetmap/odometry/block_vector.hpp"
#include "fleetmap/odometry/flat_index.hpp"

namespace fleetmap::odometry {

/// Shape of the points in one window of the grid.
enum class Shape : std::uint8_t {
  kUnknown,  ///< too few points, or only one line of a surface
  kPlane,
  kLine,
  kScatter,  ///< enough points, but neither plane nor line
};

/// Surface of the points in one cubic window. One cache line, computed only for windows that the matching
/// looks up.
struct alignas(64) Surface {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< m, map frame
  /// Normal of a plane, on the side that it was seen from; or direction of a line.
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  float thickness = 0.0f;       ///< m^2, variance across the plane or line
  float angle_variance = 0.0f;  ///< rad^2, of the direction: thickness / (count * spread)
  float count = 0.0f;           ///< points that it was fitted to
  /// Index of the plane's other side, if it was observed; for SurfaceGrid.
  std::uint32_t other_side = 0xffffffff;
  Shape shape = Shape::kUnknown;
};

/// Windows of edge length 2h on a lattice of step h: each point lies in eight of them, and near the middle of
/// one, so a lookup costs one hash probe and no surface is cut by a cell border.
///
/// A plane has a side: the one that it was observed from. The other side (of a solar panel, a sign, a wall)
/// is another surface, displaced by the thickness, and has a window of its own.
class SurfaceGrid {
 public:
  enum class Seeks { kPlanes, kLines, kUprightLines };

  /// `step` is h in m; thicker surfaces and lines (1 sigma, m) are scatter.
  /// `unevenness` m, 1 sigma, is how far surfaces of that size may depart from a plane.
  SurfaceGrid(double step, Seeks seeks, double max_thickness, double unevenness);

  struct ObservedPoint {
    Eigen::Vector3d point;   ///< m, map frame
    Eigen::Vector3f toward;  ///< direction to the sensor that saw it; zero for lines, which have no sides
  };
  void add(std::span<const ObservedPoint> points);
  /// Brings the surfaces that at() returns for these points into the caches. The map is far larger than they
  /// are, and most of the time of a lookup that comes alone is the way to memory.
  void fetch_ahead(std::span<const Eigen::Vector3d> points) const;
  /// The surface of the window whose middle is nearest to `point`, of the side that is seen from there, or
  /// null. Valid until the next prune().
  const Surface* at(const Eigen::Vector3d& point, const Eigen::Vector3f& toward);
  /// Key of the window whose middle is nearest.
  CellKey cell_at(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d scaled = point * inverse_step_;
    return pack_cell(fast_floor(scaled.x() + 0.5), fast_floor(scaled.y() + 0.5),
                     fast_floor(scaled.z() + 0.5));
  }
  /// Whether at() last found a plane here, of whichever side.
  bool known_plane(const Eigen::Vector3d& point) const;
  /// Forgets the windows farther than `radius` from `center`.
  void prune(const Eigen::Vector3d& center, double radius);
  void clear();
  std::size_t size() const { return windows_.size(); }
  /// Windows, those of other sides included.
  std::size_t windows() const { return windows_.size() + other_sides_.size(); }
  std::size_t bytes() const {
    return windows_.bytes() + other_sides_.bytes() + surfaces_.bytes() + index_.bytes();
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// The points of one window as sums, about its middle. Adding a point touches this one cache line.
  struct alignas(64) Window {
    float count = 0.0f;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();                           ///< of positions
    Eigen::Matrix<float, 6, 1> square = Eigen::Matrix<float, 6, 1>::Zero();  ///< xx xy xz yy yz zz
    Eigen::Vector3f toward = Eigen::Vector3f::Zero();  ///< sum of the directions to the sensor
    std::uint32_t surface = kNone;                     ///< index, once at() needed it
    /// Normal of the plane that at() last found, times kNormalUnit; zero if it found none.
    std::array<std::int16_t, 3> normal{};
  };
  static_assert(sizeof(Window) == 64 && sizeof(Surface) == 64);

  void add_block(std::span<const ObservedPoint> points);
  static void take(Window& window, const Eigen::Vector3f& from_middle, const Eigen::Vector3f& toward);
  static bool observed_from_behind(const Window& window, const Eigen::Vector3f& toward);
  Window& other_side_of(Window& window);
  const Surface& surface_of(Window& window, CellKey cell);
  void fit(const Window& window, CellKey cell, Surface& surface) const;

  double step_, inverse_step_;
  Seeks seeks_;
  double max_thickness_;
  double unevenness2_;  ///< m^2
  FlatIndex index_;
  BlockVector<Window> windows_, other_sides_;
  BlockVector<Surface> surfaces_;
};

}  // namespace fleetmap::odometry
