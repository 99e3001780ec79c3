#include "routes/visibility_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace fleetmap::planning {
namespace {

constexpr double kMaxPairs = 4e6;      // looked at: a few seconds
constexpr double kNeighbours = 300.0;  // of each corner that are looked at on larger sites
constexpr double kLattice = 30.0;      // m, between the points that join far corners on huge sites
constexpr std::size_t kMaxVertices = 60'000;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Corner {
  Eigen::Vector2d at;              // held off by the clearance
  Eigen::Vector2d before, behind;  // directions to the neighbours on the polygon; zero: no corner
};

double signed_area(const KeepOut& polygon) {
  double area = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    area += 0.5 * cross(polygon[k], polygon[(k + 1) % polygon.size()]);
  }
  return area;
}

/// Adds the vertex around corner k: the point where the lines at `hold_off` from both sides meet. A sharp
/// corner gets two vertices, so that they stay near it.
void add_corner(const KeepOut& polygon, std::size_t k, double orientation, double hold_off,
                std::vector<Corner>& corners) {
  const std::size_t n = polygon.size();
  const Eigen::Vector2d& p = polygon[k];
  const Eigen::Vector2d in = (p - polygon[(k + n - 1) % n]);
  const Eigen::Vector2d out = (polygon[(k + 1) % n] - p);
  if (in.norm() < 1e-6 || out.norm() < 1e-6) return;
  const Eigen::Vector2d u = in.normalized();
  const Eigen::Vector2d v = out.normalized();
  if (orientation * cross(u, v) <= 1e-6 && u.dot(v) > -0.999) return;  // paths bend at convex corners only
  const Eigen::Vector2d normal_in = orientation * Eigen::Vector2d(u.y(), -u.x());
  const Eigen::Vector2d normal_out = orientation * Eigen::Vector2d(v.y(), -v.x());
  const double cos_half = std::sqrt(std::max(0.0, 0.5 * (1.0 + u.dot(v))));
  if (cos_half > 0.5) {
    const Eigen::Vector2d bisector = (normal_in + normal_out).normalized();
    corners.push_back({p + bisector * (hold_off / cos_half), -u, v});
    return;
  }
  const double quarter = std::tan(0.25 * std::acos(std::clamp(u.dot(v), -1.0, 1.0)));
  corners.push_back({p + hold_off * (normal_in + quarter * u), -u, v});
  corners.push_back({p + hold_off * (normal_out - quarter * v), -u, v});
}

/// A shortest path touches a corner; one that would go through it can't leave it as a shortest one either.
bool touches_corner(const Corner& corner, const Eigen::Vector2d& direction) {
  const double a = cross(direction, corner.before);
  const double b = cross(direction, corner.behind);
  const double slack = 1e-3 * direction.norm();
  return !((a > slack && b < -slack) || (a < -slack && b > slack));
}

std::vector<Corner> corners_of(const Mission& mission, const SiteGrid& grid, double clearance) {
  // Half a cell more, so that a point on the border of the raster's zone is surely outside of it.
  const double hold_off = clearance + 0.75 * grid.cell();
  std::vector<Corner> corners;
  const auto add = [&](const KeepOut& polygon, double orientation) {
    std::vector<Corner> found;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      add_corner(polygon, k, orientation, hold_off, found);
    }
    for (const Corner& corner : found) {
      if (grid.clear(corner.at) && corners.size() < kMaxVertices) corners.push_back(corner);
    }
  };
  for (const KeepOut& polygon : mission.keep_out) add(polygon, signed_area(polygon) >= 0.0 ? 1.0 : -1.0);
  // Routes run inside of the boundary: they bend at the corners where it points inwards.
  if (mission.boundary) add(*mission.boundary, signed_area(*mission.boundary) >= 0.0 ? -1.0 : 1.0);
  return corners;
}

void add_lattice(const SiteGrid& grid, std::vector<Corner>& corners) {
  for (double y = grid.low().y() + 0.5 * kLattice; y < grid.high().y(); y += kLattice) {
    for (double x = grid.low().x() + 0.5 * kLattice; x < grid.high().x(); x += kLattice) {
      if (const auto free = grid.nearest_clear({x, y}, 0.5 * kLattice)) {
        corners.push_back({*free, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
      }
    }
  }
}

}  // namespace

VisibilityGraph VisibilityGraph::of(const Mission& mission, const SiteGrid& grid, double clearance) {
  std::vector<Corner> corners = corners_of(mission, grid, clearance);
  VisibilityGraph graph;
  graph.reach = std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(corners.size());
  if (0.5 * count * count > kMaxPairs) {
    const Eigen::Vector2d size = grid.high() - grid.low();
    const double share = kNeighbours / count;
    graph.reach = std::max(2.0 * kLattice, std::sqrt(share * size.x() * size.y() / 3.1416));
    add_lattice(grid, corners);
  }
  // From west to east, so that those within reach are neighbours in the list.
  std::ranges::stable_sort(corners, {}, [](const Corner& corner) { return corner.at.x(); });
  for (const Corner& corner : corners) graph.vertices.push_back(corner.at);
  graph.edges.resize(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    for (std::uint32_t j = i + 1; j < corners.size(); ++j) {
      const Eigen::Vector2d d = corners[j].at - corners[i].at;
      if (d.x() > graph.reach) break;
      if (std::abs(d.y()) > graph.reach) continue;
      if (!touches_corner(corners[i], d) || !touches_corner(corners[j], d)) continue;
      if (!grid.line_clear(corners[i].at, corners[j].at, SiteGrid::kNear)) continue;
      graph.edges[i].emplace_back(j, d.norm());
      graph.edges[j].emplace_back(i, d.norm());
    }
  }
  return graph;
}

}  // namespace fleetmap::planning
