#include "neighbor_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace fleetmap::registration {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellRange {
  Cell cell;
  std::uint32_t begin;
  std::uint32_t end;
};

/// Half of the 26 neighbours: each pair of cells is met once.
constexpr std::array<std::array<int, 3>, 13> kForward{{{1, 0, 0},
                                                       {-1, 1, 0},
                                                       {0, 1, 0},
                                                       {1, 1, 0},
                                                       {-1, -1, 1},
                                                       {0, -1, 1},
                                                       {1, -1, 1},
                                                       {-1, 0, 1},
                                                       {0, 0, 1},
                                                       {1, 0, 1},
                                                       {-1, 1, 1},
                                                       {0, 1, 1},
                                                       {1, 1, 1}}};

}  // namespace

std::vector<NeighborPair> neighbor_pairs(const std::vector<Eigen::Vector3f>& points, float radius) {
  std::vector<Cell> cells(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells[i][axis] = static_cast<std::int64_t>(std::clamp(
          std::floor(static_cast<double>(points[i][static_cast<Eigen::Index>(axis)] / radius)), -4e15, 4e15));
    }
  }
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return cells[a] != cells[b] ? cells[a] < cells[b] : a < b;
  });
  std::vector<CellRange> ranges;
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    if (ranges.empty() || ranges.back().cell != cells[order[k]]) ranges.push_back({cells[order[k]], k, k});
    ranges.back().end = k + 1;
  }
  std::vector<NeighborPair> pairs;
  const float squared_radius = radius * radius;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    const float squared = (points[a] - points[b]).squaredNorm();
    if (squared < squared_radius) pairs.push_back({a, b, std::sqrt(squared)});
  };
  for (const CellRange& range : ranges) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      for (std::uint32_t j = i + 1; j < range.end; ++j) add(order[i], order[j]);
    }
    for (const auto& step : kForward) {
      const Cell wanted{range.cell[0] + step[0], range.cell[1] + step[1], range.cell[2] + step[2]};
      const auto other = std::lower_bound(ranges.begin(), ranges.end(), wanted,
                                          [](const CellRange& r, const Cell& cell) { return r.cell < cell; });
      if (other == ranges.end() || other->cell != wanted) continue;
      for (std::uint32_t i = range.begin; i < range.end; ++i) {
        for (std::uint32_t j = other->begin; j < other->end; ++j) add(order[i], order[j]);
      }
    }
  }
  return pairs;
}

}  // namespace fleetmap::registration
