#include "fleetmap/sim/solar_farm.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "solar_farm_layout.hpp"
#include "solar_farm_parts.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kRobotRadius = 0.35;  // m, that every lane must let pass
constexpr double kMinLane = 1.5;       // m between two rows
constexpr double kMaxPlaces = 100e3;
constexpr double kMaxTerrainCells = 8e6;

Status within(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return {};
  std::ostringstream out;
  out << name << " must be from " << low << " to " << high << unit << ", found " << value;
  return failure(out.str());
}

Status first_problem(std::initializer_list<Status> checks) {
  for (const Status& check : checks) {
    if (!check) return check;
  }
  return {};
}

Status ranges(const SolarFarmConfig& c) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return first_problem({
      within("size_east", c.size_east, 25.0, 1000.0, " m"),
      within("size_north", c.size_north, 25.0, 1000.0, " m"),
      within("row_azimuth", c.row_azimuth_rad * kDegrees, -360.0, 360.0, " deg"),
      within("margin", c.margin, 0.0, 200.0, " m"),
      within("headland", c.headland, 6.0, 100.0, " m"),
      within("row_pitch", c.row_pitch, 2.0, 50.0, " m"),
      within("table_length", c.table_length, 1.0, 200.0, " m"),
      within("table_width", c.table_width, 0.5, 20.0, " m"),
      within("table_thickness", c.table_thickness, 0.005, 0.5, " m"),
      within("table_gap", c.table_gap, 0.0, 20.0, " m"),
      within("tilt", c.tilt_rad * kDegrees, 0.0, 70.0, " deg"),
      within("lower_edge_height", c.lower_edge_height, 0.2, 5.0, " m"),
      within("post_spacing", c.post_spacing, 0.5, 20.0, " m"),
      within("post_radius", c.post_radius, 0.01, 0.5, " m"),
      within("missing_tables", c.missing_tables, 0.0, 1.0, ""),
      within("tilt_jitter", c.tilt_jitter_rad * kDegrees, 0.0, 5.0, " deg"),
      within("height_jitter", c.height_jitter, 0.0, 0.3, " m"),
      within("road_every", c.road_every, 0, 10000, " tables"),
      within("road_width", c.road_width, c.table_gap, 50.0, " m"),
      within("cabins", c.cabins, 0, 1000, ""),
      within("trees", c.trees, 0, 5000, ""),
      within("trees_inside", c.trees_inside, 0, 5000, ""),
      within("terrain_cell", c.terrain_cell, 0.1, 5.0, " m"),
  });
}

Status fits(const SolarFarmConfig& c) {
  if (c.row_pitch - table_depth(c) < kMinLane) {
    std::ostringstream out;
    out << "row_pitch " << c.row_pitch << " m leaves " << c.row_pitch - table_depth(c)
        << " m between tables that are " << table_depth(c) << " m deep; a robot needs " << kMinLane
        << " m: raise row_pitch or lower table_width";
    return failure(out.str());
  }
  if (c.trees > 0 && c.margin < 5.0)
    return failure("trees stand outside the fence: margin must be at least 5 m, or trees 0");
  if (rows_that_fit(c) < 2 || tables_that_fit(c) < 1)
    return failure(
        "fewer than two rows of one table fit into size_east x size_north: enlarge the site, or "
        "lower headland, row_pitch or table_length");
  if (static_cast<double>(rows_that_fit(c)) * tables_that_fit(c) > kMaxPlaces)
    return failure("more than 100000 tables: raise row_pitch or table_length, or lower the site's size");
  const double cells =
      (c.size_east + 2.0 * c.margin) * (c.size_north + 2.0 * c.margin) / (c.terrain_cell * c.terrain_cell);
  if (cells > kMaxTerrainCells)
    return failure("more than 8 million cells of ground: raise terrain_cell or lower the site's size");
  return {};
}

/// Named as in the part of the configuration that it belongs to.
Status named(const char* part, const Status& status) {
  return status ? status : failure(std::string(part) + ": " + status.error().message);
}

Mesh mesh_of(const SolarFarmConfig& config, const SolarFarmLayout& layout) {
  Mesh mesh;
  MeshBuilder builder(mesh, layout.direction);
  const FarmGround ground{layout, Terrain(config.terrain, config.seed)};
  add_ground(config, ground, builder);
  for (std::size_t row = 0; row < layout.rows.size(); ++row) {
    for (std::size_t place = 0; place < layout.tables.size(); ++place) {
      if (layout.places[row][place] == Place::kTable) add_table(config, ground, row, place, builder);
      if (layout.places[row][place] == Place::kCabin) add_cabin(config, ground, row, place, builder);
    }
  }
  if (config.fence.enabled) add_fence(config, ground, builder);
  for (std::size_t tree = 0; tree < layout.trees.size(); ++tree) add_tree(config, ground, tree, builder);
  return mesh;
}

Status lanes_are_free(const World& world) {
  for (std::size_t k = 0; k < world.aisles().size(); ++k) {
    const Aisle& aisle = world.aisles()[k];
    const int steps = static_cast<int>(std::ceil((aisle.to - aisle.from).norm() / 0.25));
    for (int step = 0; step <= steps; ++step) {
      const Eigen::Vector2d p = aisle.from + (aisle.to - aisle.from) * (static_cast<double>(step) / steps);
      if (!world.blocked(p, kRobotRadius)) continue;
      std::ostringstream out;
      out.precision(4);
      out << "this world cannot be driven: lane " << k + 1 << " of " << world.aisles().size()
          << " is blocked at east " << p.x() << " m, north " << p.y()
          << " m; lower terrain.rolling_amplitude or terrain.rough_amplitude, or raise "
             "drivable.max_slope_deg or drivable.step_height";
      return failure(out.str());
    }
  }
  return {};
}

}  // namespace

Status FenceConfig::validate() const {
  if (!enabled) return {};
  const Status wire =
      wire_spacing == 0.0 ? Status{} : within("wire_spacing", wire_spacing, 0.04, 1.0, " m (or 0)");
  return first_problem({within("height", height, 0.5, 5.0, " m"),
                        within("post_spacing", post_spacing, 1.0, 10.0, " m"), wire,
                        within("wire_width", wire_width, 0.001, 0.05, " m")});
}

Status SolarFarmConfig::validate() const {
  const Status single =
      first_problem({ranges(*this), named("fence", fence.validate()), named("terrain", terrain.validate()),
                     named("drivable", drivable.validate())});
  return single ? fits(*this) : single;
}

Result<std::shared_ptr<const World>> make_solar_farm(const SolarFarmConfig& config) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  const SolarFarmLayout layout = lay_out(config);
  auto world = World::create(mesh_of(config, layout), config.drivable, drawing_of(config, layout));
  if (!world) return world;
  if (const Status free = lanes_are_free(**world); !free) return tl::unexpected(free.error());
  return world;
}

}  // namespace fleetmap::sim
