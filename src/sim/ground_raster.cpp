#include "ground_raster.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fleetmap::sim {
namespace {

constexpr float kNoGround = std::numeric_limits<float>::infinity();
/// Steeper triangles are walls: their feet reach below the ground and are not the ground.
constexpr double kWallCosine = 0.17;

using Triangle = std::array<Eigen::Vector3d, 3>;

/// A triangle relative to the grid's corner, in cells (z stays in metres).
Triangle in_cells(const Mesh& mesh, std::size_t k, const Grid& grid) {
  Triangle t;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d v = mesh.vertices[mesh.triangles[k][c]].cast<double>();
    t[c] = {(v.x() - grid.low.x()) / grid.cell, (v.y() - grid.low.y()) / grid.cell, v.z()};
  }
  return t;
}

bool is_wall(const Mesh& mesh, std::size_t k) {
  const auto& [a, b, c] = mesh.triangles[k];
  const Eigen::Vector3d normal = (mesh.vertices[b] - mesh.vertices[a])
                                     .cast<double>()
                                     .cross((mesh.vertices[c] - mesh.vertices[a]).cast<double>());
  return !(std::abs(normal.z()) > kWallCosine * normal.norm());
}

/// Calls `visit(cell, height)` for the cells whose centres lie under or over the triangle.
template <class Visit>
void for_centers(const Triangle& t, const Grid& grid, Visit&& visit) {
  const auto cross = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double x, double y) {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  };
  const double twice_area = cross(t[0], t[1], t[2].x(), t[2].y());
  if (twice_area == 0.0) return;
  const auto [x_low, x_high] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [y_low, y_high] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  const int first_row = std::max(0, static_cast<int>(std::ceil(y_low - 0.5)));
  const int last_row = std::min(grid.rows - 1, static_cast<int>(std::floor(y_high - 0.5)));
  const int first_column = std::max(0, static_cast<int>(std::ceil(x_low - 0.5)));
  const int last_column = std::min(grid.columns - 1, static_cast<int>(std::floor(x_high - 0.5)));
  constexpr double kEdge = -1e-9;
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const double x = column + 0.5, y = row + 0.5;
      const double a = cross(t[1], t[2], x, y) / twice_area;
      const double b = cross(t[2], t[0], x, y) / twice_area;
      const double c = 1.0 - a - b;
      if (a < kEdge || b < kEdge || c < kEdge) continue;
      visit(grid.index(column, row), static_cast<float>(a * t[0].z() + b * t[1].z() + c * t[2].z()));
    }
  }
}

/// Calls `visit(column, row)` for the four neighbours inside the grid.
template <class Visit>
void for_neighbors(const Grid& grid, int column, int row, Visit&& visit) {
  if (column > 0) visit(column - 1, row);
  if (column + 1 < grid.columns) visit(column + 1, row);
  if (row > 0) visit(column, row - 1);
  if (row + 1 < grid.rows) visit(column, row + 1);
}

/// Grows the known ground outward, ring by ring; a new cell is the mean of its neighbours of earlier rings.
void fill_holes(const Grid& grid, GroundRaster& ground) {
  std::vector<std::uint32_t> ring;
  const auto is_new = [&](std::size_t cell) { return ground.heights[cell] == kNoGround; };
  const auto collect = [&](int column, int row, std::vector<std::uint32_t>& into) {
    for_neighbors(grid, column, row, [&](int c, int r) {
      const std::size_t cell = grid.index(c, r);
      if (!is_new(cell) || ground.gap[cell] != 0) return;
      ground.gap[cell] = 1;  // in the list; its true value follows
      into.push_back(static_cast<std::uint32_t>(cell));
    });
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!is_new(grid.index(column, row))) collect(column, row, ring);
    }
  }
  for (int step = 1; !ring.empty(); ++step) {
    std::vector<float> means(ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
      double sum = 0.0;
      int known = 0;
      for_neighbors(grid, static_cast<int>(ring[k]) % grid.columns, static_cast<int>(ring[k]) / grid.columns,
                    [&](int c, int r) {
                      const float height = ground.heights[grid.index(c, r)];
                      if (height == kNoGround) return;
                      sum += height;
                      ++known;
                    });
      means[k] = static_cast<float>(sum / known);
    }
    for (std::size_t k = 0; k < ring.size(); ++k) {
      ground.heights[ring[k]] = means[k];
      ground.gap[ring[k]] = static_cast<std::uint8_t>(std::min(step, 255));
    }
    std::vector<std::uint32_t> next;
    for (const std::uint32_t cell : ring)
      collect(static_cast<int>(cell) % grid.columns, static_cast<int>(cell) / grid.columns, next);
    ring = std::move(next);
  }
}

/// A convex polygon of at most 3 + 4 corners: a triangle cut by up to four planes.
struct Polygon {
  std::array<Eigen::Vector3d, 8> corners;
  std::size_t size = 0;

  void add(const Eigen::Vector3d& p) {
    if (size < corners.size()) corners[size++] = p;
  }
};

/// The part of `polygon` with sign * (p[axis] - bound) >= 0.
Polygon cut(const Polygon& polygon, Eigen::Index axis, double bound, double sign) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size; ++k) {
    const Eigen::Vector3d& a = polygon.corners[k];
    const Eigen::Vector3d& b = polygon.corners[(k + 1) % polygon.size];
    const double inside_a = sign * (a[axis] - bound), inside_b = sign * (b[axis] - bound);
    if (inside_a >= 0.0) kept.add(a);
    if ((inside_a > 0.0 && inside_b < 0.0) || (inside_a < 0.0 && inside_b > 0.0))
      kept.add(a + (b - a) * (inside_a / (inside_a - inside_b)));
  }
  return kept;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Extent extent(const Polygon& polygon, Eigen::Index axis) {
  Extent e;
  for (std::size_t k = 0; k < polygon.size; ++k) {
    e.low = std::min(e.low, polygon.corners[k][axis]);
    e.high = std::max(e.high, polygon.corners[k][axis]);
  }
  return e;
}

/// Heights above the ground (m) between which something is in the way.
struct Band {
  double low, high;
};

class ObstacleMarker {
 public:
  ObstacleMarker(const Grid& grid, const std::vector<float>& heights, Band band,
                 std::vector<std::uint8_t>& blocked)
      : grid_(grid), heights_(heights), band_(band), blocked_(blocked) {}

  void mark(const Triangle& t) {
    Polygon polygon;
    for (const Eigen::Vector3d& corner : t) polygon.add(corner);
    const Extent x = extent(polygon, 0), y = extent(polygon, 1), z = extent(polygon, 2);
    const int first_row = cell(y.low, grid_.rows), last_row = cell(y.high, grid_.rows);
    const int first_column = cell(x.low, grid_.columns), last_column = cell(x.high, grid_.columns);
    if (out_of_band(first_column, last_column, first_row, last_row, z)) return;
    for (int row = first_row; row <= last_row; ++row) {
      const Polygon slice = cut(cut(polygon, 1, row, 1.0), 1, row + 1, -1.0);
      if (slice.size > 0) mark_row(slice, row);
    }
  }

 private:
  static int cell(double value, int count) {
    return std::clamp(static_cast<int>(std::floor(std::clamp(value, -1.0, 1e9))), 0, count - 1);
  }

  bool in_band(std::size_t index, const Extent& z) const {
    const double ground = static_cast<double>(heights_[index]);
    return z.high >= ground + band_.low && z.low <= ground + band_.high;
  }

  /// For small triangles (nearly all of a terrain) the height alone decides.
  bool out_of_band(int first_column, int last_column, int first_row, int last_row, const Extent& z) const {
    if ((last_column - first_column) * (last_row - first_row) > 100) return false;
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        if (in_band(grid_.index(column, row), z)) return false;
      }
    }
    return true;
  }

  void mark_row(const Polygon& slice, int row) {
    const Extent x = extent(slice, 0);
    const int last = cell(x.high, grid_.columns);
    for (int column = cell(x.low, grid_.columns); column <= last; ++column) {
      const std::size_t index = grid_.index(column, row);
      if (blocked_[index] != 0) continue;
      const Polygon piece = cut(cut(slice, 0, column, 1.0), 0, column + 1, -1.0);
      if (piece.size > 0 && in_band(index, extent(piece, 2))) blocked_[index] = 1;
    }
  }

  const Grid& grid_;
  const std::vector<float>& heights_;
  Band band_;
  std::vector<std::uint8_t>& blocked_;
};

/// Steeper than allowed across a cell and its neighbours, and higher than a step.
bool too_steep(const Grid& grid, const std::vector<float>& heights, int column, int row,
               const DrivableConfig& config) {
  const int west = std::max(column - 1, 0), east = std::min(column + 1, grid.columns - 1);
  const int south = std::max(row - 1, 0), north = std::min(row + 1, grid.rows - 1);
  const auto height = [&](int c, int r) { return static_cast<double>(heights[grid.index(c, r)]); };
  const double rise_x = height(east, row) - height(west, row);
  const double rise_y = height(column, north) - height(column, south);
  const double slope =
      std::hypot(rise_x / std::max(1, east - west), rise_y / std::max(1, north - south)) / grid.cell;
  return slope > std::tan(config.max_slope_rad) && std::hypot(rise_x, rise_y) > config.step_height;
}

}  // namespace

GroundRaster ground_raster(const Mesh& mesh, const Grid& grid, double step_height) {
  GroundRaster ground;
  ground.heights.assign(grid.size(), kNoGround);
  ground.gap.assign(grid.size(), 0);
  std::vector<float> lowest(grid.size(), kNoGround);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (is_wall(mesh, k)) continue;
    for_centers(in_cells(mesh, k, grid), grid,
                [&](std::size_t cell, float z) { lowest[cell] = std::min(lowest[cell], z); });
  }
  ground.heights = lowest;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (is_wall(mesh, k)) continue;
    for_centers(in_cells(mesh, k, grid), grid, [&](std::size_t cell, float z) {
      if (z <= lowest[cell] + static_cast<float>(step_height))
        ground.heights[cell] = std::max(ground.heights[cell], z);
    });
  }
  fill_holes(grid, ground);
  // A mesh of walls alone has no ground at all.
  for (float& height : ground.heights) {
    if (height == kNoGround) height = 0.0f;
  }
  return ground;
}

std::vector<std::uint8_t> obstacle_raster(const Mesh& mesh, const Grid& grid, const GroundRaster& ground,
                                          const DrivableConfig& config) {
  constexpr double kBridgedHole = 0.5;  // m from solid ground
  const auto bridged = static_cast<int>(std::floor(kBridgedHole / grid.cell));
  std::vector<std::uint8_t> blocked(grid.size(), 0);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t index = grid.index(column, row);
      blocked[index] =
          ground.gap[index] > bridged || too_steep(grid, ground.heights, column, row, config) ? 1 : 0;
    }
  }
  // Allowed slopes must not rise above their own cells.
  const double own_rise = 0.75 * grid.cell * std::tan(config.max_slope_rad);
  ObstacleMarker marker(grid, ground.heights, {std::max(config.step_height, own_rise), config.robot_height},
                        blocked);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) marker.mark(in_cells(mesh, k, grid));
  return blocked;
}

}  // namespace fleetmap::sim
