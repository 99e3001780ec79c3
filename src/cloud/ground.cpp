#include "fleetmap/cloud/ground.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace fleetmap::cloud {
namespace {

constexpr int kNone = -1;
constexpr int kContactCells = 4;        // reach of the search for other surfaces below a surface
constexpr double kElevatedShare = 0.3;  // of its cells that lie above another surface
constexpr std::size_t kMinSurfaceCells = 5;
constexpr float kMaxCoordinate = 1e6f;  // m; further points cannot be told apart from noise anyway

/// Height over the ground plane: z = height + slope . (xy - center).
struct Plane {
  double height = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

struct Cell {
  int x = 0;
  int y = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< lowest point, levelled frame
  std::optional<Plane> plane;                     ///< about the cell's center
  int surface = kNone;
};

class GroundGrid {
 public:
  GroundGrid(const std::vector<Eigen::Vector3f>& levelled, const GroundConfig& config) : config_(config) {
    for (const auto& p : levelled) add(p.cast<double>());
    fit_planes();
    const std::size_t surfaces = join_surfaces();
    select_ground(surfaces);
    nearest_ground_.reserve(cells_.size());
    for (const Cell& cell : cells_) nearest_ground_.push_back(ground_near(cell.x, cell.y));
  }

  bool is_ground(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d p = point.cast<double>();
    const int x = index(p.x());
    const int y = index(p.y());
    const int at = find(x, y);
    if (at == kNone || nearest_ground_[static_cast<std::size_t>(at)] == kNone) return false;
    const Cell& cell = cells_[static_cast<std::size_t>(nearest_ground_[static_cast<std::size_t>(at)])];
    const int away = std::max(std::abs(cell.x - x), std::abs(cell.y - y));
    const double above = p.z() - height(cell, p.head<2>());
    const double reach = static_cast<double>(config_.thickness_m) + 0.05 * away;
    return above <= reach && above >= -4.0 * reach;
  }

 private:
  int index(double coordinate) const {
    return static_cast<int>(std::floor(coordinate / static_cast<double>(config_.cell_m)));
  }
  static std::uint64_t key(int x, int y) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
  }
  Eigen::Vector2d center(const Cell& cell) const {
    return Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5) * static_cast<double>(config_.cell_m);
  }
  double height(const Cell& cell, const Eigen::Vector2d& xy) const {
    return cell.plane->height + cell.plane->slope.dot(xy - center(cell));
  }
  int find(int x, int y) const {
    const auto found = lookup_.find(key(x, y));
    return found == lookup_.end() ? kNone : found->second;
  }

  void add(const Eigen::Vector3d& p) {
    const int x = index(p.x());
    const int y = index(p.y());
    const auto [at, is_new] = lookup_.try_emplace(key(x, y), static_cast<int>(cells_.size()));
    if (is_new) cells_.push_back({x, y, p, std::nullopt, kNone});
    Cell& cell = cells_[static_cast<std::size_t>(at->second)];
    if (p.z() < cell.low.z()) cell.low = p;
  }

  void fit_planes() {
    for (Cell& cell : cells_) {
      cell.plane = fit(cell, 1);
      if (!cell.plane) cell.plane = fit(cell, 2);
    }
  }

  /// The lowest points of the cells around, relative to the cell's centre.
  std::vector<Eigen::Vector3d> lows_around(const Cell& cell, int reach) const {
    std::vector<Eigen::Vector3d> lows;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int other = find(cell.x + dx, cell.y + dy);
        if (other == kNone) continue;
        const Eigen::Vector3d& low = cells_[static_cast<std::size_t>(other)].low;
        lows.emplace_back(low.x() - center(cell).x(), low.y() - center(cell).y(), low.z());
      }
    }
    return lows;
  }

  /// Robust plane through the lowest points of the cells around; nothing where they are too few, in a line,
  /// too steep or too rough.
  std::optional<Plane> fit(const Cell& cell, int reach) const {
    const std::vector<Eigen::Vector3d> lows = lows_around(cell, reach);
    if (lows.size() < 5) return std::nullopt;
    std::vector<double> heights;
    for (const auto& low : lows) heights.push_back(low.z());
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2),
                     heights.end());
    Eigen::Vector3d plane(heights[heights.size() / 2], 0.0, 0.0);
    const double step = static_cast<double>(config_.step_m);
    for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
      const double scale = factor * step;
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      double weights = 0.0;
      for (const auto& low : lows) {
        const Eigen::Vector3d row(1.0, low.x(), low.y());
        const double residual = (low.z() - plane.dot(row)) / scale;
        const double weight = 1.0 / ((1.0 + residual * residual) * (1.0 + residual * residual));
        A += weight * row * row.transpose();
        b += weight * low.z() * row;
        weights += weight;
      }
      const Eigen::Vector2d mean = A.block<2, 1>(1, 0) / weights;
      const Eigen::Matrix2d spread = A.bottomRightCorner<2, 2>() / weights - mean * mean.transpose();
      const double cell_m = static_cast<double>(config_.cell_m);
      const double min_spread =
          0.5 * spread.trace() - std::hypot(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
      if (weights < 3.0 || min_spread < 0.1 * cell_m * cell_m) {
        return std::nullopt;
      }
      plane = A.ldlt().solve(b);
    }
    const auto off = [&](const Eigen::Vector3d& low) {
      return std::abs(low.z() - plane.dot(Eigen::Vector3d(1.0, low.x(), low.y())));
    };
    const auto close =
        std::count_if(lows.begin(), lows.end(), [&](const auto& low) { return off(low) < step; });
    const Eigen::Vector3d own(cell.low.x() - center(cell).x(), cell.low.y() - center(cell).y(), cell.low.z());
    if (!plane.allFinite() || off(own) > step || 10 * close < 7 * static_cast<std::ptrdiff_t>(lows.size()) ||
        plane.tail<2>().norm() > std::tan(static_cast<double>(config_.max_slope_rad))) {
      return std::nullopt;
    }
    return Plane{plane[0], plane.tail<2>()};
  }

  double allowance(const Cell& a, const Cell& b) const {
    return static_cast<double>(config_.step_m) +
           std::tan(static_cast<double>(config_.max_slope_change_rad)) * (center(a) - center(b)).norm();
  }
  bool continues(const Cell& a, const Cell& b) const {
    const double limit = allowance(a, b);
    return std::abs(height(a, center(b)) - b.plane->height) < limit &&
           std::abs(height(b, center(a)) - a.plane->height) < limit;
  }

  std::size_t join_surfaces() {
    int surfaces = 0;
    std::vector<int> open;
    for (std::size_t start = 0; start < cells_.size(); ++start) {
      if (!cells_[start].plane || cells_[start].surface != kNone) continue;
      cells_[start].surface = surfaces;
      open.assign(1, static_cast<int>(start));
      while (!open.empty()) {
        const Cell& cell = cells_[static_cast<std::size_t>(open.back())];
        open.pop_back();
        for_cells_around(cell, 1, [&](int other) {
          Cell& next = cells_[static_cast<std::size_t>(other)];
          if (!next.plane || next.surface != kNone || !continues(cell, next)) return;
          next.surface = surfaces;
          open.push_back(other);
        });
      }
      ++surfaces;
    }
    return static_cast<std::size_t>(surfaces);
  }

  template <class Visit>
  void for_cells_around(const Cell& cell, int reach, Visit visit) const {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int other = find(cell.x + dx, cell.y + dy);
        if (other != kNone && (dx != 0 || dy != 0)) visit(other);
      }
    }
  }

  bool is_above_another(const Cell& cell, const std::vector<std::size_t>& sizes) const {
    bool above = false;
    for_cells_around(cell, kContactCells, [&](int at) {
      const Cell& other = cells_[static_cast<std::size_t>(at)];
      if (above || !other.plane || other.surface == cell.surface) return;
      if (sizes[static_cast<std::size_t>(other.surface)] < kMinSurfaceCells) return;
      above = cell.plane->height - height(other, center(cell)) > allowance(cell, other);
    });
    return above;
  }

  void select_ground(std::size_t surfaces) {
    std::vector<std::size_t> sizes(surfaces, 0);
    std::vector<std::size_t> elevated(surfaces, 0);
    for (const Cell& cell : cells_) {
      if (cell.plane) ++sizes[static_cast<std::size_t>(cell.surface)];
    }
    for (const Cell& cell : cells_) {
      if (cell.plane && is_above_another(cell, sizes)) ++elevated[static_cast<std::size_t>(cell.surface)];
    }
    const double cell_area = static_cast<double>(config_.cell_m) * static_cast<double>(config_.cell_m);
    ground_.assign(surfaces, false);
    for (std::size_t s = 0; s < surfaces; ++s) {
      const auto size = static_cast<double>(sizes[s]);
      ground_[s] = size * cell_area >= static_cast<double>(config_.min_area_m2) &&
                   static_cast<double>(elevated[s]) < kElevatedShare * size;
    }
  }

  /// The cell at x, y if it is ground, or else the nearest ground within two cells.
  int ground_near(int x, int y) const {
    int best = kNone;
    int best_distance = 9;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int distance = dx * dx + dy * dy;
        if (distance >= best_distance) continue;
        const int other = find(x + dx, y + dy);
        if (other == kNone) continue;
        const Cell& cell = cells_[static_cast<std::size_t>(other)];
        if (!cell.plane || !ground_[static_cast<std::size_t>(cell.surface)]) continue;
        best = other;
        best_distance = distance;
      }
    }
    return best;
  }

  const GroundConfig& config_;
  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, int> lookup_;
  std::vector<bool> ground_;         ///< by surface
  std::vector<int> nearest_ground_;  ///< by cell, kNone where there is none near
};

}  // namespace

GroundSplit split_ground(const PointCloud& cloud, const GroundConfig& config) {
  const Eigen::Matrix3f R_level_cloud = levelling(config.up.cast<double>()).cast<float>();
  GroundSplit split;
  std::vector<Eigen::Vector3f> levelled;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!p.allFinite()) {
      ++split.refused;
    } else if (p.cwiseAbs().maxCoeff() > kMaxCoordinate) {
      split.kept.push_back(i);
    } else {
      levelled.push_back(R_level_cloud * p);
      indices.push_back(i);
    }
  }
  const GroundGrid grid(levelled, config);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    (grid.is_ground(levelled[k]) ? split.ground : split.kept).push_back(indices[k]);
  }
  std::sort(split.kept.begin(), split.kept.end());
  return split;
}

}  // namespace fleetmap::cloud
