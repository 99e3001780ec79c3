#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fleetmap/odometry/flat_index.hpp"
#include "fleetmap/odometry/loam_config.hpp"

namespace fleetmap::odometry {

enum class Shape : std::uint8_t {
  kUnknown,  ///< too few points to tell, or they only show one line of a surface
  kPlane,
  kLine,
  kScatter,  ///< enough points, but neither plane nor line
};

/// The points of one cubic window as a Gaussian, and what surface it shows. A plane has a side: the one that
/// it was seen from. What is seen of the other side (of a solar panel, a sign, a wall) is another surface,
/// off by its thickness, and has a window of its own.
///
/// A window takes two cache lines: what the matching reads is in the first one.
struct alignas(64) SurfaceWindow {
  static constexpr std::uint32_t kNone = 0xffffffff;

  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, of the window, map frame
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();    ///< about `center`
  /// Normal of a plane, on the side that it was seen from; or direction of a line.
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  float thickness = 0.0f;            ///< m^2, variance across the plane or line
  float angle_variance = 0.0f;       ///< rad^2, of the direction: thickness / (count * spread)
  std::uint32_t other_side = kNone;  ///< index of that of the plane's other side, if it was seen
  Shape shape = Shape::kUnknown;
  bool stale = true;  ///< points came in since the fields above were computed

  float count = 0.0f;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();  ///< of positions about `center`
  Eigen::Matrix<float, 6, 1> square =
      Eigen::Matrix<float, 6, 1>::Zero();            ///< xx xy xz yy yz zz about `center`
  Eigen::Vector3f toward = Eigen::Vector3f::Zero();  ///< sum of the directions to the sensor
};

/// Windows of edge length 2h on a lattice of step h: each point lies in eight of them, and near the middle of
/// one, so a lookup costs one hash probe and no surface is cut by a cell border.
class SurfaceGrid {
 public:
  enum class Seeks { kPlanes, kLines, kUprightLines };

  /// `step` is h in m; thicker surfaces and lines (1 sigma, m) are scatter.
  /// `bend` m, 1 sigma, is how far surfaces of that size may depart from what part of them was seen.
  SurfaceGrid(double step, Seeks seeks, double max_thickness, double bend);

  struct SeenPoint {
    Eigen::Vector3d point;   ///< m, map frame
    Eigen::Vector3f toward;  ///< direction to the sensor that saw it; zero for lines, which have no sides
  };
  void add(std::span<const SeenPoint> seen);
  /// Brings the windows that at() returns for these points into the caches. The map is far larger than they
  /// are, and most of the time of a lookup that comes alone is the way to memory.
  void fetch_ahead(std::span<const Eigen::Vector3d> points) const;
  /// The window whose middle is nearest to `point`, of the side that is seen from there, or null. Valid until
  /// the next add() or prune().
  const SurfaceWindow* at(const Eigen::Vector3d& point, const Eigen::Vector3f& toward);
  /// Forgets the windows farther than `radius` from `center`.
  void prune(const Eigen::Vector3d& center, double radius);
  void clear();
  std::size_t size() const { return windows_.size(); }

 private:
  CellKey cell_at(const Eigen::Vector3d& point) const;
  void add_block(std::span<const SeenPoint> seen);
  SurfaceWindow& other_side_of(SurfaceWindow& window);
  void refresh(SurfaceWindow& window) const;

  double step_, inverse_step_;
  Seeks seeks_;
  double max_thickness_;
  double bend2_;  ///< m^2
  FlatIndex index_;
  std::vector<SurfaceWindow> windows_, other_sides_;
};

/// What the robot has seen around it: surfaces at two scales, upright posts among them, and edges.
class LocalMap {
 public:
  explicit LocalMap(const LoamConfig& config);

  /// `sensor`: where the points were seen from.
  void add_surfaces(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& sensor);
  void add_edges(std::span<const Eigen::Vector3d> points);
  /// Makes surface_at() at these points, some dozens, faster.
  void fetch_ahead(std::span<const Eigen::Vector3d> points) const { fine_.fetch_ahead(points); }
  /// A plane or upright line near `point`: from the finer windows where they hold enough points, else from
  /// the coarser ones; null where there is none.
  const SurfaceWindow* surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor);
  /// An edge near `point`, or null.
  const SurfaceWindow* edge_at(const Eigen::Vector3d& point);
  void prune(const Eigen::Vector3d& center, double radius);
  void clear();
  bool empty() const { return coarse_.size() == 0; }

 private:
  SurfaceGrid fine_, coarse_, posts_, edges_;
  std::vector<SurfaceGrid::SeenPoint> seen_;  ///< keeps its memory between calls
};

}  // namespace fleetmap::odometry
