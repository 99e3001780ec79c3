#include "fleetmap/eval/density.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace fleetmap::eval {
namespace {

using Cell = std::array<std::int32_t, 3>;

struct InCell {
  Cell cell;
  std::uint32_t index;
  /// Written out: the array's own comparison is a call of memcmp.
  bool operator<(const InCell& other) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (cell[k] != other.cell[k]) return cell[k] < other.cell[k];
    return index < other.index;
  }
};

/// Finite points sorted by their cell.
std::vector<InCell> sorted_cells(const std::vector<Eigen::Vector3f>& points, float edge) {
  std::vector<InCell> cells;
  cells.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3f cell = (points[i] / edge).array().floor();
    if (!points[i].allFinite() || cell.abs().maxCoeff() > 1e9f) continue;
    cells.push_back({{static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                      static_cast<std::int32_t>(cell[2])},
                     static_cast<std::uint32_t>(i)});
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Points of the three cells (x, y, z - 1 .. z + 1): one run, because z is sorted last.
void gather_column(const std::vector<InCell>& cells, const std::vector<Eigen::Vector3f>& points,
                   const Cell& middle, std::vector<Eigen::Vector3f>& out) {
  auto at = std::lower_bound(cells.begin(), cells.end(), InCell{{middle[0], middle[1], middle[2] - 1}, 0});
  for (; at != cells.end() && at->cell[0] == middle[0] && at->cell[1] == middle[1] &&
         at->cell[2] <= middle[2] + 1;
       ++at) {
    out.push_back(points[at->index]);
  }
}

}  // namespace

std::vector<std::uint32_t> density_at(const std::vector<Eigen::Vector3f>& queries,
                                      const std::vector<Eigen::Vector3f>& points, float radius) {
  std::vector<std::uint32_t> counts(queries.size(), 0);
  if (!(radius > 0.0f) || !std::isfinite(radius)) return counts;
  const std::vector<InCell> cells = sorted_cells(points, radius);
  const std::vector<InCell> asked = sorted_cells(queries, radius);
  const float squared = radius * radius;
  std::vector<Eigen::Vector3f> near;
  for (std::size_t begin = 0; begin < asked.size();) {
    const Cell cell = asked[begin].cell;
    near.clear();
    for (const int x : {-1, 0, 1}) {
      for (const int y : {-1, 0, 1}) {
        gather_column(cells, points, {cell[0] + x, cell[1] + y, cell[2]}, near);
      }
    }
    for (; begin < asked.size() && asked[begin].cell == cell; ++begin) {
      const Eigen::Vector3f q = queries[asked[begin].index];
      std::uint32_t count = 0;
      for (const Eigen::Vector3f& p : near) count += (p - q).squaredNorm() <= squared ? 1u : 0u;
      counts[asked[begin].index] = count;
    }
  }
  return counts;
}

}  // namespace fleetmap::eval
