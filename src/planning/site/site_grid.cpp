#include "site/site_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fleetmap::planning {
namespace {

constexpr double kMaxCells = 24e6;  // of a raster: 24 MB; larger sites get coarser cells

struct Box {
  Eigen::Vector2d low, high;
};

Box extent(const Mission& mission, double margin, std::span<const Eigen::Vector2d> also) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{Eigen::Vector2d::Constant(kInfinity), Eigen::Vector2d::Constant(-kInfinity)};
  const auto include = [&box](std::span<const Eigen::Vector2d> points) {
    for (const Eigen::Vector2d& p : points) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  };
  if (mission.boundary) {
    include(*mission.boundary);
    return box;
  }
  for (const Row& row : mission.rows) include(row.waypoints);
  for (const KeepOut& polygon : mission.keep_out) include(polygon);
  include(also);
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

}  // namespace

SiteGrid::SiteGrid(const Mission& mission, double clearance, double cell, double margin,
                   std::span<const Eigen::Vector2d> also) {
  const Box box = extent(mission, margin, also);
  const Eigen::Vector2d size = box.high - box.low;
  low_ = box.low;
  cell_ = std::max(cell, std::sqrt(size.x() * size.y() / kMaxCells));
  width_ = static_cast<int>(std::ceil(size.x() / cell_));
  height_ = static_cast<int>(std::ceil(size.y() / cell_));
  zones_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (const KeepOut& polygon : mission.keep_out) {
    fill(polygon);
    draw_outline(polygon, clearance);
  }
  if (mission.boundary) fence_in(*mission.boundary, clearance);
}

void SiteGrid::draw_outline(const KeepOut& polygon, double clearance) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d& a = polygon[k];
    const Eigen::Vector2d& b = polygon[(k + 1) % polygon.size()];
    draw_edge(a, b, clearance, kNear);
    draw_edge(a, b, 0.71 * cell_, kInside);  // thin walls must not slip between cell centres
  }
}

/// The ground outside of the boundary is a keep-out.
void SiteGrid::fence_in(const KeepOut& boundary, double clearance) {
  const std::vector<std::uint8_t> within = std::exchange(zones_, std::vector<std::uint8_t>(zones_.size(), 0));
  fill(boundary);
  for (std::size_t k = 0; k < zones_.size(); ++k) {
    zones_[k] = zones_[k] != 0 ? within[k] : static_cast<std::uint8_t>(kNear | kInside);
  }
  draw_outline(boundary, clearance);
}

void SiteGrid::mark(int y, double x_from, double x_to, std::uint8_t zone) {
  const int first = std::max(0, static_cast<int>(std::ceil((x_from - low_.x()) / cell_ - 0.5)));
  const int last = std::min(width_ - 1, static_cast<int>(std::floor((x_to - low_.x()) / cell_ - 0.5)));
  std::uint8_t* row = zones_.data() + static_cast<std::ptrdiff_t>(y) * width_;
  for (int x = first; x <= last; ++x) row[x] = static_cast<std::uint8_t>(row[x] | zone);
}

/// Even-odd rule on the cell centres.
void SiteGrid::fill(const KeepOut& polygon) {
  double bottom = polygon.front().y();
  double top = bottom;
  for (const Eigen::Vector2d& p : polygon) {
    bottom = std::min(bottom, p.y());
    top = std::max(top, p.y());
  }
  const int first = std::max(0, static_cast<int>(std::floor((bottom - low_.y()) / cell_)));
  const int last = std::min(height_ - 1, static_cast<int>(std::ceil((top - low_.y()) / cell_)));
  std::vector<double> crossings;
  for (int y = first; y <= last; ++y) {
    const double line = centre(y, 1);
    crossings.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Eigen::Vector2d& a = polygon[k];
      const Eigen::Vector2d& b = polygon[(k + 1) % polygon.size()];
      if ((a.y() > line) == (b.y() > line)) continue;
      crossings.push_back(a.x() + (line - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::ranges::sort(crossings);
    for (std::size_t k = 1; k < crossings.size(); k += 2) {
      mark(y, crossings[k - 1], crossings[k], kNear | kInside);
    }
  }
}

/// All cells whose centre lies within `radius` of the edge: a capsule is convex, so each line of the raster
/// cuts it in one interval, bounded by its two discs and its rectangle.
void SiteGrid::draw_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius,
                         std::uint8_t zone) {
  const double bottom = std::min(a.y(), b.y()) - radius;
  const double top = std::max(a.y(), b.y()) + radius;
  const int first = std::max(0, static_cast<int>(std::floor((bottom - low_.y()) / cell_)));
  const int last = std::min(height_ - 1, static_cast<int>(std::ceil((top - low_.y()) / cell_)));
  const Eigen::Vector2d along = b - a;
  const double length = along.norm();
  const Eigen::Vector2d side =
      length > 0.0 ? Eigen::Vector2d(-along.y(), along.x()) * (radius / length) : Eigen::Vector2d(0.0, 0.0);
  const Eigen::Vector2d corners[4] = {a + side, b + side, b - side, a - side};
  for (int y = first; y <= last; ++y) {
    const double line = centre(y, 1);
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (const Eigen::Vector2d& end : {a, b}) {
      const double half = radius * radius - (line - end.y()) * (line - end.y());
      if (half < 0.0) continue;
      from = std::min(from, end.x() - std::sqrt(half));
      to = std::max(to, end.x() + std::sqrt(half));
    }
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d& p = corners[k];
      const Eigen::Vector2d& q = corners[(k + 1) % 4];
      if ((p.y() > line) == (q.y() > line)) continue;
      const double x = p.x() + (line - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
      from = std::min(from, x);
      to = std::max(to, x);
    }
    if (from <= to) mark(y, from, to, zone);
  }
}

std::uint8_t SiteGrid::zone(const Eigen::Vector2d& p) const {
  const double x = std::floor((p.x() - low_.x()) / cell_);
  const double y = std::floor((p.y() - low_.y()) / cell_);
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return kNear | kInside;
  return zones_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

bool SiteGrid::line_clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::uint8_t mask) const {
  if (((zone(a) | zone(b)) & mask) != 0) return false;
  // Amanatides and Woo: from cell to cell under the line.
  const Eigen::Vector2d p = (a - low_) / cell_;
  const Eigen::Vector2d q = (b - low_) / cell_;
  int x = static_cast<int>(p.x());
  int y = static_cast<int>(p.y());
  const int end_x = static_cast<int>(q.x());
  const int end_y = static_cast<int>(q.y());
  const Eigen::Vector2d d = q - p;
  const int step_x = d.x() > 0.0 ? 1 : -1;
  const int step_y = d.y() > 0.0 ? 1 : -1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double delta_x = d.x() != 0.0 ? std::abs(1.0 / d.x()) : kNever;
  const double delta_y = d.y() != 0.0 ? std::abs(1.0 / d.y()) : kNever;
  double next_x = d.x() != 0.0 ? ((step_x > 0 ? x + 1 : x) - p.x()) / d.x() : kNever;
  double next_y = d.y() != 0.0 ? ((step_y > 0 ? y + 1 : y) - p.y()) / d.y() : kNever;
  int left = std::abs(end_x - x) + std::abs(end_y - y);
  for (; left > 0; --left) {
    if (next_x < next_y) {
      x += step_x;
      next_x += delta_x;
    } else {
      y += step_y;
      next_y += delta_y;
    }
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
    if (zones_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] &
        mask) {
      return false;
    }
  }
  return true;
}

std::optional<Eigen::Vector2d> SiteGrid::nearest_clear(const Eigen::Vector2d& p, double radius) const {
  if (clear(p)) return p;
  const Eigen::Vector2d from = p.cwiseMax(low_).cwiseMin(high() - Eigen::Vector2d::Constant(1e-6));
  if ((from - p).norm() > radius) return std::nullopt;
  const bool inside = (zone(from) & kInside) != 0;
  const int reach = static_cast<int>(std::ceil(radius / cell_));
  const int x0 = static_cast<int>((from.x() - low_.x()) / cell_);
  const int y0 = static_cast<int>((from.y() - low_.y()) / cell_);
  std::optional<Eigen::Vector2d> best;
  double best_distance = radius;
  for (int ring = 0; ring <= reach && !(best && ring * cell_ > best_distance + 2.0 * cell_); ++ring) {
    for (int dy = -ring; dy <= ring; ++dy) {
      const int step = std::abs(dy) == ring ? 1 : std::max(1, 2 * ring);
      for (int dx = -ring; dx <= ring; dx += step) {
        const Eigen::Vector2d q(centre(x0 + dx, 0), centre(y0 + dy, 1));
        const double distance = (q - p).norm();
        if (distance >= best_distance || !clear(q)) continue;
        if (!inside && !line_clear(from, q, kInside)) continue;
        best = q;
        best_distance = distance;
      }
    }
  }
  return best;
}

}  // namespace fleetmap::planning
