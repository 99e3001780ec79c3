#include "fleetmap/odometry/surface_grid.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fleetmap::odometry {
namespace {

/// Windows stop taking points here: what was seen first, with the least drift, stays the anchor.
constexpr float kMaxCount = 250.0f;
/// A surface is fitted anew when its window has so many times the points that it was fitted to.
constexpr float kGrown = 1.05f;
constexpr float kMinPlaneCount = 7.0f;
constexpr float kMinLineCount = 4.0f;
/// Across over along variance: flatter is a plane.
constexpr double kPlaneRatio = 0.08;
constexpr double kLineRatio = 0.05;
constexpr double kPostRatio = 0.15;  // a post has a girth
/// Least extent (1 sigma) along both axes of a plane, as a share of h: one ring on a floor is no plane.
constexpr double kMinExtent = 0.12;
constexpr double kUpright = 0.9;
/// Sine of the angle behind a plane from which on it is seen from its other side; normals err a little.
constexpr float kBehind = 0.1f;
constexpr float kNormalUnit = 32767.0f;
/// Points whose windows are fetched together before they are used.
constexpr std::size_t kQueryBlock = 16;
constexpr std::size_t kCorners = 8;

}  // namespace

SurfaceGrid::SurfaceGrid(double step, Seeks seeks, double max_thickness, double unevenness)
    : step_(step),
      inverse_step_(1.0 / step),
      seeks_(seeks),
      max_thickness_(max_thickness),
      unevenness2_(unevenness * unevenness) {}

inline void SurfaceGrid::take(Window& window, const Eigen::Vector3f& from_middle,
                              const Eigen::Vector3f& toward) {
  if (window.count >= kMaxCount) return;
  const Eigen::Vector3f& d = from_middle;
  window.count += 1.0f;
  window.sum += d;
  window.toward += toward;
  window.square[0] += d.x() * d.x();
  window.square[1] += d.x() * d.y();
  window.square[2] += d.x() * d.z();
  window.square[3] += d.y() * d.y();
  window.square[4] += d.y() * d.z();
  window.square[5] += d.z() * d.z();
}

inline bool SurfaceGrid::observed_from_behind(const Window& window, const Eigen::Vector3f& toward) {
  return static_cast<float>(window.normal[0]) * toward.x() +
             static_cast<float>(window.normal[1]) * toward.y() +
             static_cast<float>(window.normal[2]) * toward.z() <
         -kBehind * kNormalUnit;
}

SurfaceGrid::Window& SurfaceGrid::other_side_of(Window& window) {
  std::uint32_t& other = surfaces_[window.surface].other_side;
  if (other == kNone) {
    other = static_cast<std::uint32_t>(other_sides_.size());
    other_sides_.push_back({});
  }
  return other_sides_[other];
}

void SurfaceGrid::add(std::span<const ObservedPoint> points) {
  for (std::size_t begin = 0; begin < points.size(); begin += kQueryBlock) {
    add_block(points.subspan(begin, std::min(kQueryBlock, points.size() - begin)));
  }
}

void SurfaceGrid::add_block(std::span<const ObservedPoint> points) {
  struct Target {
    CellKey cell;
    std::uint32_t window;
  };
  std::array<Target, kQueryBlock * kCorners> targets;
  std::array<Eigen::Array3d, kQueryBlock> in_cell;  // m, from its least corner
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Array3d scaled = points[k].point.array() * inverse_step_;
    const std::int64_t cell[3] = {fast_floor(scaled.x()), fast_floor(scaled.y()), fast_floor(scaled.z())};
    for (int axis = 0; axis < 3; ++axis)
      in_cell[k][axis] = step_ * (scaled[axis] - static_cast<double>(cell[axis]));
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      // Window w covers the cells w - 1 and w; its middle is the lattice point w.
      Target& target = targets[k * kCorners + corner];
      target.cell = pack_cell(cell[0] + static_cast<std::int64_t>(corner & 1),
                              cell[1] + static_cast<std::int64_t>(corner >> 1 & 1),
                              cell[2] + static_cast<std::int64_t>(corner >> 2 & 1));
      index_.prefetch(target.cell);
    }
  }
  const auto used = std::span(targets).first(points.size() * kCorners);
  for (Target& target : used) {
    target.window = index_.insert(target.cell);
    if (target.window == windows_.size()) {
      windows_.push_back({});
    } else {
      __builtin_prefetch(&windows_[target.window]);
    }
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    const Eigen::Vector3f& toward = points[k / kCorners].toward;
    const std::size_t corner = k % kCorners;
    const Eigen::Array3d middle(corner & 1 ? step_ : 0.0, corner & 2 ? step_ : 0.0, corner & 4 ? step_ : 0.0);
    const Eigen::Vector3f from_middle = (in_cell[k / kCorners] - middle).matrix().cast<float>();
    Window& window = windows_[used[k].window];
    take(observed_from_behind(window, toward) ? other_side_of(window) : window, from_middle, toward);
  }
}

void SurfaceGrid::fetch_ahead(std::span<const Eigen::Vector3d> points) const {
  for (const Eigen::Vector3d& point : points) index_.prefetch(cell_at(point));
  for (const Eigen::Vector3d& point : points) {
    const std::uint32_t i = index_.find(cell_at(point));
    if (i != FlatIndex::kAbsent) __builtin_prefetch(&windows_[i]);
  }
  for (const Eigen::Vector3d& point : points) {
    const std::uint32_t i = index_.find(cell_at(point));
    if (i == FlatIndex::kAbsent || windows_[i].surface == kNone) continue;
    __builtin_prefetch(&surfaces_[windows_[i].surface]);
  }
}

const Surface* SurfaceGrid::at(const Eigen::Vector3d& point, const Eigen::Vector3f& toward) {
  const CellKey cell = cell_at(point);
  const std::uint32_t i = index_.find(cell);
  if (i == FlatIndex::kAbsent) return nullptr;
  Window& window = windows_[i];
  const Surface& surface = surface_of(window, cell);
  if (!observed_from_behind(window, toward)) return &surface;
  return surface.other_side == kNone ? nullptr : &surface_of(other_sides_[surface.other_side], cell);
}

bool SurfaceGrid::known_plane(const Eigen::Vector3d& point) const {
  const std::uint32_t i = index_.find(cell_at(point));
  return i != FlatIndex::kAbsent && windows_[i].normal != std::array<std::int16_t, 3>{};
}

const Surface& SurfaceGrid::surface_of(Window& window, CellKey cell) {
  if (window.surface == kNone) {
    window.surface = static_cast<std::uint32_t>(surfaces_.size());
    surfaces_.push_back({});
  }
  Surface& surface = surfaces_[window.surface];
  if (window.count > kGrown * surface.count) {
    fit(window, cell, surface);
    for (int axis = 0; axis < 3; ++axis) {
      const float component = surface.shape == Shape::kPlane ? surface.direction[axis] : 0.0f;
      window.normal[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(component * kNormalUnit);
    }
  }
  return surface;
}

void SurfaceGrid::fit(const Window& window, CellKey cell, Surface& surface) const {
  surface.count = window.count;
  surface.shape = Shape::kUnknown;
  if (window.count < (seeks_ == Seeks::kPlanes ? kMinPlaneCount : kMinLineCount)) return;
  const double n = window.count;
  const Eigen::Vector3d mean = window.sum.cast<double>() / n;
  const auto& q = window.square;
  Eigen::Matrix3d S;
  S << q[0], q[1], q[2], q[1], q[3], q[4], q[2], q[4], q[5];
  S = S / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(S);
  const Eigen::Vector3d l = solver.eigenvalues().cwiseMax(1e-7);
  surface.mean = step_ * unpack_cell(cell) + mean;
  const double thick2 = max_thickness_ * max_thickness_;
  const double extent2 = kMinExtent * kMinExtent * step_ * step_;
  auto set_shape = [&](Shape shape, int axis, double across, double along) {
    surface.shape = shape;
    surface.direction = solver.eigenvectors().col(axis).cast<float>();
    surface.thickness = static_cast<float>(across + unevenness2_);
    surface.angle_variance = static_cast<float>(across / (n * along));
  };
  if (seeks_ == Seeks::kPlanes) {
    if (l[1] <= extent2) return;
    if (l[0] < kPlaneRatio * l[1] && l[0] < thick2) {
      set_shape(Shape::kPlane, 0, l[0], l[1]);
      if (surface.direction.dot(window.toward) < 0.0f) surface.direction = -surface.direction;
    } else {
      surface.shape = Shape::kScatter;
    }
    return;
  }
  // LiDARs draw level lines on surfaces, hardly upright ones: those are posts.
  const bool upright = std::abs(solver.eigenvectors()(2, 2)) > kUpright;
  const double ratio = seeks_ == Seeks::kLines ? kLineRatio : upright ? kPostRatio : 0.0;
  if (l[1] < ratio * l[2] && l[1] < thick2 && l[2] > extent2) {
    set_shape(Shape::kLine, 2, l[1], l[2]);
  } else {
    surface.shape = Shape::kScatter;
  }
}

void SurfaceGrid::prune(const Eigen::Vector3d& center, double radius) {
  BlockVector<Window> kept_other_sides;
  BlockVector<Surface> kept_surfaces;
  const auto move_surface_of = [&](Window& window) -> Surface* {
    if (window.surface == kNone) return nullptr;
    Surface& kept = kept_surfaces.push_back(surfaces_[window.surface]);
    window.surface = static_cast<std::uint32_t>(kept_surfaces.size() - 1);
    return &kept;
  };
  std::vector<CellKey> cells(windows_.size());
  index_.for_each([&](CellKey cell, std::uint32_t i) { cells[i] = cell; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    if ((step_ * unpack_cell(cells[i]) - center).squaredNorm() >= radius * radius) continue;
    cells[kept] = cells[i];
    Window& window = windows_[kept++] = windows_[i];
    Surface* surface = move_surface_of(window);
    if (surface == nullptr || surface->other_side == kNone) continue;
    move_surface_of(kept_other_sides.push_back(other_sides_[surface->other_side]));
    surface->other_side = static_cast<std::uint32_t>(kept_other_sides.size() - 1);
  }
  windows_.shrink(kept);
  other_sides_ = std::move(kept_other_sides);
  surfaces_ = std::move(kept_surfaces);
  index_.clear_for(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    index_.prefetch(cells[std::min(i + kQueryBlock, kept - 1)]);
    index_.insert(cells[i]);
  }
}

void SurfaceGrid::clear() {
  index_.clear_for(0);
  windows_.shrink(0);
  other_sides_.shrink(0);
  surfaces_.shrink(0);
}

}  // namespace fleetmap::odometry
