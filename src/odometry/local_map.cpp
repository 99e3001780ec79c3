#include "fleetmap/odometry/local_map.hpp"

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
constexpr double kLineThickness = 0.1;  // m
/// Sine of the angle behind a plane from which on it is seen from its other side; normals err a little.
constexpr float kBehind = 0.1f;
const Eigen::Vector3f kNoSide = Eigen::Vector3f::Zero();  // of a line
/// Points whose windows are fetched together before they are used.
constexpr std::size_t kBlock = 16;
constexpr std::size_t kCorners = 8;

void prefetch_both_lines(const SurfaceWindow& window) {
  const char* memory = reinterpret_cast<const char*>(&window);
  __builtin_prefetch(memory);
  __builtin_prefetch(memory + 64);
}

bool seen_from_behind(const SurfaceWindow& window, const Eigen::Vector3f& toward) {
  return window.shape == Shape::kPlane && window.direction.dot(toward) < -kBehind;
}

void take(SurfaceWindow& window, const Eigen::Vector3d& point, const Eigen::Vector3f& toward) {
  if (window.count >= kMaxCount) return;
  const Eigen::Vector3f d = (point - window.center).cast<float>();
  window.count += 1.0f;
  window.sum += d;
  window.toward += toward;
  window.square[0] += d.x() * d.x();
  window.square[1] += d.x() * d.y();
  window.square[2] += d.x() * d.z();
  window.square[3] += d.y() * d.y();
  window.square[4] += d.y() * d.z();
  window.square[5] += d.z() * d.z();
  window.stale = true;
}

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
    std::int64_t w[3];
    CellKey key;
    std::uint32_t window;
  };
  std::array<Target, kBlock * kCorners> targets;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Eigen::Vector3d scaled = seen[k].point * inverse_step_;
    const std::int64_t cell[3] = {fast_floor(scaled.x()), fast_floor(scaled.y()), fast_floor(scaled.z())};
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      Target& target = targets[k * kCorners + corner];
      // Window w covers the cells w - 1 and w; its middle is the lattice point w.
      for (std::size_t axis = 0; axis < 3; ++axis) {
        target.w[axis] = cell[axis] + static_cast<std::int64_t>(corner >> axis & 1);
      }
      target.key = pack_cell(target.w[0], target.w[1], target.w[2]);
      index_.prefetch(target.key);
    }
  }
  const auto used = std::span(targets).first(seen.size() * kCorners);
  for (Target& target : used) {
    target.window = index_.insert(target.key);
    if (target.window == windows_.size()) {
      windows_.emplace_back().center =
          step_ * Eigen::Vector3d(static_cast<double>(target.w[0]), static_cast<double>(target.w[1]),
                                  static_cast<double>(target.w[2]));
    } else {
      prefetch_both_lines(windows_[target.window]);
    }
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto& [point, toward] = seen[k / kCorners];
    SurfaceWindow& window = windows_[used[k].window];
    take(seen_from_behind(window, toward) ? other_side_of(window) : window, point, toward);
  }
}

SurfaceWindow& SurfaceGrid::other_side_of(SurfaceWindow& window) {
  if (window.other_side == SurfaceWindow::kNone) {
    window.other_side = static_cast<std::uint32_t>(other_sides_.size());
    other_sides_.emplace_back().center = window.center;
  }
  return other_sides_[window.other_side];
}

/// Of the window whose middle is nearest.
CellKey SurfaceGrid::cell_at(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d scaled = point * inverse_step_;
  return pack_cell(fast_floor(scaled.x() + 0.5), fast_floor(scaled.y() + 0.5), fast_floor(scaled.z() + 0.5));
}

void SurfaceGrid::fetch_ahead(std::span<const Eigen::Vector3d> points) const {
  for (const Eigen::Vector3d& point : points) index_.prefetch(cell_at(point));
  for (const Eigen::Vector3d& point : points) {
    const std::uint32_t i = index_.find(cell_at(point));
    if (i != FlatIndex::kAbsent) prefetch_both_lines(windows_[i]);
  }
}

const SurfaceWindow* SurfaceGrid::at(const Eigen::Vector3d& point, const Eigen::Vector3f& toward) {
  const std::uint32_t i = index_.find(cell_at(point));
  if (i == FlatIndex::kAbsent) return nullptr;
  SurfaceWindow& window = windows_[i];
  if (window.stale) refresh(window);
  if (!seen_from_behind(window, toward)) return &window;
  if (window.other_side == SurfaceWindow::kNone) return nullptr;
  SurfaceWindow& other = other_sides_[window.other_side];
  if (other.stale) refresh(other);
  return &other;
}

void SurfaceGrid::refresh(SurfaceWindow& window) const {
  window.stale = false;
  window.shape = Shape::kUnknown;
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
  window.mean = mean.cast<float>();
  const double thick2 = max_thickness_ * max_thickness_;
  const double extent2 = kMinExtent * kMinExtent * step_ * step_;
  auto settle = [&](Shape shape, int axis, double across, double along) {
    window.shape = shape;
    window.direction = solver.eigenvectors().col(axis).cast<float>();
    window.thickness = static_cast<float>(across + bend2_);
    window.angle_variance = static_cast<float>(across / (n * along));
  };
  if (seeks_ == Seeks::kPlanes) {
    if (l[1] <= extent2) return;
    if (l[0] < kPlaneRatio * l[1] && l[0] < thick2) {
      settle(Shape::kPlane, 0, l[0], l[1]);
      if (window.direction.dot(window.toward) < 0.0f) window.direction = -window.direction;
    } else {
      window.shape = Shape::kScatter;
    }
    return;
  }
  // LiDARs draw level lines on surfaces, hardly upright ones: those are posts.
  const bool upright = std::abs(solver.eigenvectors()(2, 2)) > kUpright;
  const double ratio = seeks_ == Seeks::kLines ? kLineRatio : upright ? kPostRatio : 0.0;
  if (l[1] < ratio * l[2] && l[1] < thick2 && l[2] > extent2) {
    settle(Shape::kLine, 2, l[1], l[2]);
  } else {
    window.shape = Shape::kScatter;
  }
}

void SurfaceGrid::prune(const Eigen::Vector3d& center, double radius) {
  std::vector<SurfaceWindow> kept, kept_other_sides;
  kept.reserve(windows_.size());
  kept_other_sides.reserve(other_sides_.size());
  for (SurfaceWindow& window : windows_) {
    if ((window.center - center).squaredNorm() >= radius * radius) continue;
    if (window.other_side != SurfaceWindow::kNone) {
      kept_other_sides.push_back(other_sides_[window.other_side]);
      window.other_side = static_cast<std::uint32_t>(kept_other_sides.size() - 1);
    }
    kept.push_back(window);
  }
  other_sides_.swap(kept_other_sides);
  windows_.swap(kept);
  index_.clear();
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    index_.prefetch(cell_at(windows_[std::min(i + kBlock, windows_.size() - 1)].center));
    index_.insert(cell_at(windows_[i].center));
  }
}

void SurfaceGrid::clear() {
  index_.clear();
  windows_.clear();
  other_sides_.clear();
}

LocalMap::LocalMap(const LoamConfig& config)
    : fine_(config.fine_resolution, SurfaceGrid::Seeks::kPlanes, std::max(0.08, 3.0 * config.range_noise),
            0.0),
      coarse_(config.coarse_resolution, SurfaceGrid::Seeks::kPlanes, std::max(0.15, 4.0 * config.range_noise),
              config.coarse_noise),
      posts_(0.6 * config.fine_resolution, SurfaceGrid::Seeks::kUprightLines, kLineThickness, 0.0),
      edges_(config.fine_resolution, SurfaceGrid::Seeks::kLines, kLineThickness, 0.0) {}

void LocalMap::add_surfaces(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& sensor) {
  seen_.clear();
  for (const Eigen::Vector3d& point : points) {
    seen_.push_back({point, (sensor - point).normalized().cast<float>()});
  }
  fine_.add(seen_);
  coarse_.add(seen_);
  for (SurfaceGrid::SeenPoint& seen : seen_) seen.toward = kNoSide;
  posts_.add(seen_);
}

void LocalMap::add_edges(std::span<const Eigen::Vector3d> points) {
  seen_.clear();
  for (const Eigen::Vector3d& point : points) seen_.push_back({point, kNoSide});
  edges_.add(seen_);
}

const SurfaceWindow* LocalMap::surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor) {
  const Eigen::Vector3f toward = (sensor - point).normalized().cast<float>();
  const SurfaceWindow* fine = fine_.at(point, toward);
  if (fine != nullptr && fine->shape == Shape::kPlane) return fine;
  const SurfaceWindow* post = fine != nullptr ? posts_.at(point, kNoSide) : nullptr;
  if (post != nullptr && post->shape == Shape::kLine) return post;
  if (fine != nullptr && fine->shape == Shape::kScatter) return nullptr;
  const SurfaceWindow* coarse = coarse_.at(point, toward);
  return coarse != nullptr && coarse->shape == Shape::kPlane ? coarse : nullptr;
}

const SurfaceWindow* LocalMap::edge_at(const Eigen::Vector3d& point) {
  const SurfaceWindow* edge = edges_.at(point, kNoSide);
  return edge != nullptr && edge->shape == Shape::kLine ? edge : nullptr;
}

void LocalMap::prune(const Eigen::Vector3d& center, double radius) {
  fine_.prune(center, radius);
  coarse_.prune(center, radius);
  posts_.prune(center, radius);
  edges_.prune(center, radius);
}

void LocalMap::clear() {
  fine_.clear();
  coarse_.clear();
  posts_.clear();
  edges_.clear();
}

}  // namespace fleetmap::odometry
