#include "fleetmap/odometry/surface_grid.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace fleetmap::odometry {
namespace {

/// Windows stop taking points here: what was seen first, with the least drift, stays the anchor.
constexpr float kMaxCount = 250.0f;
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
/// Points whose windows are fetched together before they are used.
constexpr std::size_t kBlock = 16;
constexpr std::size_t kCorners = 8;

}  // namespace

SurfaceGrid::SurfaceGrid(double step, Seeks seeks, double max_thickness, double bend)
    : step_(step),
      inverse_step_(1.0 / step),
      seeks_(seeks),
      max_thickness_(max_thickness),
      bend2_(bend * bend) {}

void SurfaceGrid::add(std::span<const SeenPoint> seen) {
  for (std::size_t begin = 0; begin < seen.size(); begin += kBlock) {
    add_block(seen.subspan(begin, std::min(kBlock, seen.size() - begin)));
  }
}

void SurfaceGrid::add_block(std::span<const SeenPoint> seen) {
  struct Target {
    CellKey cell;
    std::uint32_t window;
  };
  std::array<Target, kBlock * kCorners> targets;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Eigen::Vector3d scaled = seen[k].point * inverse_step_;
    const std::int64_t cell[3] = {fast_floor(scaled.x()), fast_floor(scaled.y()), fast_floor(scaled.z())};
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      // Window w covers the cells w - 1 and w; its middle is the lattice point w.
      Target& target = targets[k * kCorners + corner];
      target.cell = pack_cell(cell[0] + static_cast<std::int64_t>(corner & 1),
                              cell[1] + static_cast<std::int64_t>(corner >> 1 & 1),
                              cell[2] + static_cast<std::int64_t>(corner >> 2 & 1));
      index_.prefetch(target.cell);
    }
  }
  const auto used = std::span(targets).first(seen.size() * kCorners);
  for (Target& target : used) {
    target.window = index_.insert(target.cell);
    if (target.window == windows_.size()) {
      windows_.push_back({}).cell = target.cell;
    } else {
      __builtin_prefetch(&windows_[target.window]);
    }
  }
  for (const Target& target : used) prefetch_surface(windows_[target.window]);
  for (std::size_t k = 0; k < used.size(); ++k) {
    const SeenPoint& point = seen[k / kCorners];
    Window& window = windows_[used[k].window];
    take(seen_from_behind(window, point.toward) ? other_side_of(window) : window, middle(used[k].cell),
         point);
  }
}

void SurfaceGrid::take(Window& window, const Eigen::Vector3d& middle, const SeenPoint& seen) {
  if (window.count >= kMaxCount) return;
  const Eigen::Vector3f d = (seen.point - middle).cast<float>();
  window.count += 1.0f;
  window.sum += d;
  window.toward += seen.toward;
  window.square[0] += d.x() * d.x();
  window.square[1] += d.x() * d.y();
  window.square[2] += d.x() * d.z();
  window.square[3] += d.y() * d.y();
  window.square[4] += d.y() * d.z();
  window.square[5] += d.z() * d.z();
}

bool SurfaceGrid::seen_from_behind(const Window& window, const Eigen::Vector3f& toward) const {
  if (seeks_ != Seeks::kPlanes || window.surface == kNone) return false;
  const Surface& surface = surfaces_[window.surface];
  return surface.shape == Shape::kPlane && surface.direction.dot(toward) < -kBehind;
}

SurfaceGrid::Window& SurfaceGrid::other_side_of(Window& window) {
  std::uint32_t& other = surfaces_[window.surface].other_side;
  if (other == kNone) {
    other = static_cast<std::uint32_t>(other_sides_.size());
    other_sides_.push_back({}).cell = window.cell;
  }
  return other_sides_[other];
}

/// Of the window whose middle is nearest.
CellKey SurfaceGrid::cell_at(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d scaled = point * inverse_step_;
  return pack_cell(fast_floor(scaled.x() + 0.5), fast_floor(scaled.y() + 0.5), fast_floor(scaled.z() + 0.5));
}

Eigen::Vector3d SurfaceGrid::middle(CellKey cell) const { return step_ * unpack_cell(cell); }

void SurfaceGrid::prefetch_surface(const Window& window) const {
  if (seeks_ == Seeks::kPlanes && window.surface != kNone) __builtin_prefetch(&surfaces_[window.surface]);
}

void SurfaceGrid::fetch_ahead(std::span<const Eigen::Vector3d> points) const {
  for (const Eigen::Vector3d& point : points) index_.prefetch(cell_at(point));
  for (const Eigen::Vector3d& point : points) {
    const std::uint32_t i = index_.find(cell_at(point));
    if (i != FlatIndex::kAbsent) __builtin_prefetch(&windows_[i]);
  }
  for (const Eigen::Vector3d& point : points) {
    const std::uint32_t i = index_.find(cell_at(point));
    if (i != FlatIndex::kAbsent) prefetch_surface(windows_[i]);
  }
}

const Surface* SurfaceGrid::at(const Eigen::Vector3d& point, const Eigen::Vector3f& toward) {
  const std::uint32_t i = index_.find(cell_at(point));
  if (i == FlatIndex::kAbsent) return nullptr;
  Window& window = windows_[i];
  const Surface& surface = surface_of(window);
  if (!seen_from_behind(window, toward)) return &surface;
  return surface.other_side == kNone ? nullptr : &surface_of(other_sides_[surface.other_side]);
}

bool SurfaceGrid::known_plane(const Eigen::Vector3d& point) const {
  const std::uint32_t i = index_.find(cell_at(point));
  if (i == FlatIndex::kAbsent || windows_[i].surface == kNone) return false;
  return surfaces_[windows_[i].surface].shape == Shape::kPlane;
}

const Surface& SurfaceGrid::surface_of(Window& window) {
  if (window.surface == kNone) {
    window.surface = static_cast<std::uint32_t>(surfaces_.size());
    surfaces_.push_back({});
  }
  Surface& surface = surfaces_[window.surface];
  if (surface.count != window.count) fit(window, surface);
  return surface;
}

void SurfaceGrid::fit(const Window& window, Surface& surface) const {
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
  surface.mean = middle(window.cell) + mean;
  const double thick2 = max_thickness_ * max_thickness_;
  const double extent2 = kMinExtent * kMinExtent * step_ * step_;
  auto settle = [&](Shape shape, int axis, double across, double along) {
    surface.shape = shape;
    surface.direction = solver.eigenvectors().col(axis).cast<float>();
    surface.thickness = static_cast<float>(across + bend2_);
    surface.angle_variance = static_cast<float>(across / (n * along));
  };
  if (seeks_ == Seeks::kPlanes) {
    if (l[1] <= extent2) return;
    if (l[0] < kPlaneRatio * l[1] && l[0] < thick2) {
      settle(Shape::kPlane, 0, l[0], l[1]);
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
    settle(Shape::kLine, 2, l[1], l[2]);
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
  std::size_t kept = 0;
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    if ((middle(windows_[i].cell) - center).squaredNorm() >= radius * radius) continue;
    Window& window = windows_[kept++] = windows_[i];
    Surface* surface = move_surface_of(window);
    if (surface == nullptr || surface->other_side == kNone) continue;
    move_surface_of(kept_other_sides.push_back(other_sides_[surface->other_side]));
    surface->other_side = static_cast<std::uint32_t>(kept_other_sides.size() - 1);
  }
  windows_.shrink(kept);
  other_sides_ = std::move(kept_other_sides);
  surfaces_ = std::move(kept_surfaces);
  index_.clear();
  for (std::size_t i = 0; i < kept; ++i) {
    index_.prefetch(windows_[std::min(i + kBlock, kept - 1)].cell);
    index_.insert(windows_[i].cell);
  }
}

void SurfaceGrid::clear() {
  index_.clear();
  windows_.shrink(0);
  other_sides_.shrink(0);
  surfaces_.shrink(0);
}

}  // namespace fleetmap::odometry
