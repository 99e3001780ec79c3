#include "correlation_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::registration {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Bounds {
  Eigen::Vector2f low, high;
};

Bounds bounds_of(const std::vector<Eigen::Vector3f>& points) {
  Bounds bounds{points.front().head<2>(), points.front().head<2>()};
  for (const auto& p : points) {
    bounds.low = bounds.low.cwiseMin(p.head<2>());
    bounds.high = bounds.high.cwiseMax(p.head<2>());
  }
  return bounds;
}

std::size_t at(const Eigen::Vector2i& size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x()) + static_cast<std::size_t>(x);
}

Floor floor_of(const std::vector<Eigen::Vector3f>& points, const Bounds& bounds, float cell_m) {
  Floor floor;
  floor.cell_m = cell_m;
  floor.origin = bounds.low - Eigen::Vector2f::Constant(cell_m);
  floor.size = ((bounds.high - bounds.low) / cell_m).array().floor().cast<int>() + 3;
  const float high = std::numeric_limits<float>::max();
  const auto cells = static_cast<std::size_t>(floor.size.x()) * static_cast<std::size_t>(floor.size.y());
  std::vector<float> lows(cells, high);
  for (const auto& p : points) {
    const Eigen::Vector2i c = ((p.head<2>() - floor.origin) / cell_m).cast<int>();
    float& low = lows[at(floor.size, c.x(), c.y())];
    low = std::min(low, p.z());
  }
  floor.heights.assign(cells, kNan);
  for (int y = 0; y < floor.size.y(); ++y) {
    for (int x = 0; x < floor.size.x(); ++x) {
      float lowest = high;
      for (int v = std::max(0, y - 1); v <= std::min(floor.size.y() - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(floor.size.x() - 1, x + 1); ++u) {
          lowest = std::min(lowest, lows[at(floor.size, u, v)]);
        }
      }
      if (lowest < high) floor.heights[at(floor.size, x, y)] = lowest;
    }
  }
  return floor;
}

void mark(CorrelationGrid& map, int x, int y, int layer) {
  const std::size_t plane = static_cast<std::size_t>(map.size.x()) * static_cast<std::size_t>(map.size.y());
  std::uint8_t* cells = map.layers.data() + static_cast<std::size_t>(layer) * plane;
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      std::uint8_t& cell = cells[at(map.size, u, v)];
      cell = std::max(cell, static_cast<std::uint8_t>(u == x && v == y ? 2 : 1));
    }
  }
}

}  // namespace

float Floor::at(const Eigen::Vector2f& p) const {
  const Eigen::Vector2f g = (p - origin) / cell_m;
  if (!(g.x() >= 0.0f && g.y() >= 0.0f && g.x() < static_cast<float>(size.x()) &&
        g.y() < static_cast<float>(size.y())))
    return kNan;
  return heights[registration::at(size, static_cast<int>(g.x()), static_cast<int>(g.y()))];
}

CorrelationGrid correlation_grid(const std::vector<Eigen::Vector3f>& points,
                                 const CorrelationGridConfig& config) {
  CorrelationGrid map;
  map.cell_m = config.cell_m;
  map.floor.cell_m = config.floor_cell_m;
  if (points.empty()) return map;
  const Bounds bounds = bounds_of(points);
  map.floor = floor_of(points, bounds, config.floor_cell_m);
  map.origin = bounds.low - Eigen::Vector2f::Constant(2.0f * config.cell_m);
  map.size = ((bounds.high - bounds.low) / config.cell_m).array().floor().cast<int>() + 5;
  const std::size_t plane = static_cast<std::size_t>(map.size.x()) * static_cast<std::size_t>(map.size.y());
  map.layers.assign(plane * kLayers, 0);
  map.observed_size = (map.size.array() + kObservedCells - 1) / kObservedCells;
  map.observed.assign(
      static_cast<std::size_t>(map.observed_size.x()) * static_cast<std::size_t>(map.observed_size.y()), 0);
  std::vector<std::uint16_t> own(plane, 0);  // bit per layer
  std::vector<CorrelationCell> all;
  for (const auto& p : points) {
    const Eigen::Vector2i c = ((p.head<2>() - map.origin) / config.cell_m).cast<int>();
    map.observed[at(map.observed_size, c.x() / kObservedCells, c.y() / kObservedCells)] = 1;
    const float height = p.z() - map.floor.at(p.head<2>()) - config.min_height_m;
    if (!(height >= 0.0f)) continue;
    const auto layer_at = [&](float h) {
      return std::clamp(static_cast<int>(h / config.layer_m), 0, kLayers - 1);
    };
    const int layer = layer_at(height);
    for (const int l : {layer_at(height - 0.25f * config.layer_m), layer_at(height + 0.25f * config.layer_m)})
      mark(map, c.x(), c.y(), l);
    std::uint16_t& bits = own[at(map.size, c.x(), c.y())];
    if ((bits >> layer & 1) != 0) continue;
    bits = static_cast<std::uint16_t>(bits | 1 << layer);
    all.push_back({p.head<2>(), layer});
  }
  const std::size_t wanted = std::min(config.max_cells, all.size());
  for (std::size_t k = 0; k < wanted; ++k) map.cells.push_back(all[k * all.size() / wanted]);
  return map;
}

}  // namespace fleetmap::registration
