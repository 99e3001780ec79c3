#include "solar_farm_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "counter_random.hpp"

namespace fleetmap::sim {
namespace {

constexpr std::uint64_t kMissing = 0xA1, kCabin = 0xA2, kTree = 0xA3,
                        kTreeInside = 0xA4;  // separate streams of chance
constexpr double kCrown = 2.4;               // m, the widest reach of a tree
constexpr double kRim = 0.05;                // m around what the drawing shows

bool road_before(const SolarFarmConfig& config, int table) {
  return config.road_every > 0 && table > 0 && table % config.road_every == 0;
}

double gap_before(const SolarFarmConfig& config, int table) {
  if (table == 0) return 0.0;
  return road_before(config, table) ? config.road_width : config.table_gap;
}

double row_length(const SolarFarmConfig& config, int tables) {
  double length = 0.0;
  for (int k = 0; k < tables; ++k) length += gap_before(config, k) + config.table_length;
  return length;
}

void place_tables(const SolarFarmConfig& config, SolarFarmLayout& layout) {
  const int tables = tables_that_fit(config), rows = rows_that_fit(config);
  double at = -0.5 * row_length(config, tables);
  for (int k = 0; k < tables; ++k) {
    at += gap_before(config, k);
    layout.tables.push_back(at + 0.5 * config.table_length);
    layout.beside_road.push_back(k == 0 || k + 1 == tables || road_before(config, k) ||
                                 road_before(config, k + 1));
    at += config.table_length;
  }
  for (int k = 0; k < rows; ++k) layout.rows.push_back((k - 0.5 * (rows - 1)) * config.row_pitch);
  layout.places.assign(static_cast<std::size_t>(rows),
                       std::vector<TableSlot>(static_cast<std::size_t>(tables), TableSlot::kTable));
  for (std::size_t row = 0; row < layout.places.size(); ++row) {
    for (std::size_t k = 0; k < layout.places[row].size(); ++k) {
      if (uniform_at(config.seed, kMissing, row, k) < config.missing_tables)
        layout.places[row][k] = TableSlot::kEmpty;
    }
  }
}

/// In the places beside roads that chance likes best.
void place_cabins(const SolarFarmConfig& config, SolarFarmLayout& layout) {
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> candidates;
  for (std::size_t row = 0; row < layout.rows.size(); ++row) {
    for (std::size_t k = 0; k < layout.tables.size(); ++k) {
      if (layout.beside_road[k]) candidates.push_back({uniform_at(config.seed, kCabin, row, k), {row, k}});
    }
  }
  std::ranges::sort(candidates);
  const std::size_t count = std::min(candidates.size(), static_cast<std::size_t>(config.cabins));
  for (std::size_t k = 0; k < count; ++k) {
    const auto [row, place] = candidates[k].second;
    layout.places[row][place] = TableSlot::kCabin;
  }
}

/// In the strip outside the fence, along its length by chance.
void place_trees(const SolarFarmConfig& config, SolarFarmLayout& layout) {
  const Eigen::Vector2d& half = layout.half_site;
  for (int k = 0; k < config.trees; ++k) {
    const auto chance = [&](std::uint64_t what) {
      return uniform_at(config.seed, kTree, static_cast<std::uint64_t>(k), what);
    };
    const double outside = std::lerp(kCrown, std::max(kCrown, config.margin - kCrown), chance(0));
    const double along = 2.0 * chance(1) - 1.0;
    const double side = chance(2) < 0.5 ? -1.0 : 1.0;
    const bool north_or_south = chance(3) < half.x() / (half.x() + half.y());
    const Eigen::Vector2d center = north_or_south
                                       ? Eigen::Vector2d(along * half.x(), side * (half.y() + outside))
                                       : Eigen::Vector2d(side * (half.x() + outside), along * half.y());
    layout.trees.push_back({center, 0.1 + 0.15 * chance(4)});
  }
}

/// In the strips of the rows, so that the lanes stay free.
void place_trees_inside(const SolarFarmConfig& config, SolarFarmLayout& layout) {
  const double reach = layout.tables.back() + 0.5 * config.table_length;
  for (int k = 0; k < config.trees_inside; ++k) {
    const auto chance = [&](std::uint64_t what) {
      return uniform_at(config.seed, kTreeInside, static_cast<std::uint64_t>(k), what);
    };
    const auto row = static_cast<std::size_t>(chance(0) * static_cast<double>(layout.rows.size()));
    const double across = (chance(1) - 0.5) * layout.depth;
    layout.trees.push_back(
        {{(2.0 * chance(2) - 1.0) * reach, layout.rows[row] + across}, 0.1 + 0.15 * chance(3)});
  }
}

Footprint rectangle(const SolarFarmLayout& layout, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {layout.enu(low), layout.enu({high.x(), low.y()}), layout.enu(high),
          layout.enu({low.x(), high.y()})};
}

Footprint around(const SolarFarmLayout& layout, const Eigen::Vector2d& center, const Eigen::Vector2d& half) {
  const Eigen::Vector2d reach = half + Eigen::Vector2d::Constant(kRim);
  return rectangle(layout, center - reach, center + reach);
}

/// Tables that are drawn next to each other are one block.
void add_row(const SolarFarmConfig& config, const SolarFarmLayout& layout, std::size_t row,
             std::vector<Footprint>& drawn) {
  const std::vector<TableSlot>& places = layout.places[row];
  const double v = layout.rows[row];
  const Eigen::Vector2d reach(0.5 * config.table_length + kRim, 0.5 * layout.depth + kRim);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k] == TableSlot::kCabin) {
      drawn.push_back(around(layout, {layout.tables[k], v}, 0.5 * cabin_size(config)));
      continue;
    }
    const std::size_t first = k;
    while (k + 1 < places.size() && places[k + 1] != TableSlot::kCabin &&
           !road_before(config, static_cast<int>(k) + 1))
      ++k;
    drawn.push_back(rectangle(layout, Eigen::Vector2d(layout.tables[first], v) - reach,
                              Eigen::Vector2d(layout.tables[k], v) + reach));
  }
}

std::vector<Aisle> aisles_of(const SolarFarmConfig& config, const SolarFarmLayout& layout) {
  const double reach = layout.tables.back() + 0.5 * config.table_length + 0.5 * config.headland;
  std::vector<Aisle> aisles;
  const auto add = [&](double v) { aisles.push_back({layout.enu({-reach, v}), layout.enu({reach, v})}); };
  // Outer lanes keep the distance that the inner ones have, or the middle of a narrower headland.
  const double outer = std::min(0.5 * config.row_pitch, 0.5 * (layout.depth + config.headland));
  add(layout.rows.front() - outer);
  for (std::size_t k = 0; k + 1 < layout.rows.size(); ++k) add(0.5 * (layout.rows[k] + layout.rows[k + 1]));
  add(layout.rows.back() + outer);
  return aisles;
}

}  // namespace

double table_depth(const SolarFarmConfig& config) {
  const double flattest = std::max(0.0, config.tilt_rad - config.tilt_jitter_rad);
  return config.table_width * std::cos(flattest) + config.table_thickness;
}

Eigen::Vector2d cabin_size(const SolarFarmConfig& config) {
  return {std::min(6.0, config.table_length), std::min(2.5, table_depth(config))};
}

int rows_that_fit(const SolarFarmConfig& config) {
  const double free = config.size_north - 2.0 * config.headland - table_depth(config);
  return free < 0.0 ? 0 : 1 + static_cast<int>(std::floor(free / config.row_pitch));
}

int tables_that_fit(const SolarFarmConfig& config) {
  const double free = config.size_east - 2.0 * config.headland;
  int tables = 0;
  while (row_length(config, tables + 1) <= free) ++tables;
  return tables;
}

SolarFarmLayout lay_out(const SolarFarmConfig& config) {
  SolarFarmLayout layout;
  layout.direction = {std::sin(config.row_azimuth_rad), std::cos(config.row_azimuth_rad)};
  if (std::abs(layout.direction.y()) < 1e-8)
    layout.direction = {std::copysign(1.0, layout.direction.x()), 0.0};
  layout.half_site = 0.5 * Eigen::Vector2d(config.size_east, config.size_north);
  layout.depth = table_depth(config);
  place_tables(config, layout);
  place_cabins(config, layout);
  place_trees(config, layout);
  place_trees_inside(config, layout);
  return layout;
}

SiteDrawing drawing_of(const SolarFarmConfig& config, const SolarFarmLayout& layout) {
  SiteDrawing drawing;
  drawing.lanes = aisles_of(config, layout);
  for (std::size_t row = 0; row < layout.rows.size(); ++row) add_row(config, layout, row, drawing.keep_out);
  const double outside = config.fence.enabled ? 0.0 : config.margin;
  const Eigen::Vector2d reach = layout.half_site + Eigen::Vector2d::Constant(outside);
  drawing.boundary = rectangle(layout, -reach, reach);
  return drawing;
}

}  // namespace fleetmap::sim
