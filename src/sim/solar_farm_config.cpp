#include "fleetmap/sim/solar_farm_config.hpp"

#include <numbers>
#include <sstream>
#include <string>

#include "solar_farm_layout.hpp"
#include "spec_rules.hpp"

namespace fleetmap::sim {
namespace {

constexpr double kMinLane = 1.5;  // m between two rows
constexpr double kMaxPlaces = 100e3;
constexpr double kMaxTerrainCells = 8e6;

Status ranges(const SolarFarmConfig& c) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return first_failure({
      in_range("size_east", c.size_east, 25.0, 1000.0, " m"),
      in_range("size_north", c.size_north, 25.0, 1000.0, " m"),
      in_range("row_azimuth", c.row_azimuth_rad * kDegrees, -360.0, 360.0, " deg"),
      in_range("margin", c.margin, 0.0, 200.0, " m"),
      in_range("headland", c.headland, 6.0, 100.0, " m"),
      in_range("row_pitch", c.row_pitch, 2.0, 50.0, " m"),
      in_range("table_length", c.table_length, 1.0, 200.0, " m"),
      in_range("table_width", c.table_width, 0.5, 20.0, " m"),
      in_range("table_thickness", c.table_thickness, 0.005, 0.5, " m"),
      in_range("table_gap", c.table_gap, 0.0, 20.0, " m"),
      in_range("tilt", c.tilt_rad * kDegrees, 0.0, 70.0, " deg"),
      in_range("lower_edge_height", c.lower_edge_height, 0.2, 5.0, " m"),
      in_range("post_spacing", c.post_spacing, 0.5, 20.0, " m"),
      in_range("post_radius", c.post_radius, 0.01, 0.5, " m"),
      in_range("missing_tables", c.missing_tables, 0.0, 1.0, ""),
      in_range("tilt_jitter", c.tilt_jitter_rad * kDegrees, 0.0, 5.0, " deg"),
      in_range("height_jitter", c.height_jitter, 0.0, 0.3, " m"),
      in_range("road_every", c.road_every, 0, 10000, " tables"),
      in_range("road_width", c.road_width, c.table_gap, 50.0, " m"),
      in_range("cabins", c.cabins, 0, 1000, ""),
      in_range("trees", c.trees, 0, 5000, ""),
      in_range("trees_inside", c.trees_inside, 0, 5000, ""),
      in_range("terrain_cell", c.terrain_cell, 0.1, 5.0, " m"),
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
Status in_section(const char* part, const Status& status) {
  return status ? status : failure(std::string(part) + ": " + status.error().message);
}

}  // namespace

Status SolarFarmConfig::validate() const {
  const Status single =
      first_failure({ranges(*this), in_section("fence", fence.validate()),
                     in_section("terrain", terrain.validate()), in_section("drivable", drivable.validate())});
  return single ? fits(*this) : single;
}

}  // namespace fleetmap::sim
