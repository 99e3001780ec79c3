#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/change/find_changes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::change {

/// A line a change: kind, size, position in the map, and, with the origin of the map's ENU, in WGS84 and UTM.
std::string to_table(const Changes& changes, const std::optional<GeoPoint>& origin);

/// Features of a point each, in WGS84 (RFC 7946), with the properties of the table. `origin` is that of ENU.
/// Without heights if they are `above_sea_level`, since GeoJSON defines them above the ellipsoid.
std::string to_geojson(const Changes& changes, const GeoPoint& origin, bool above_sea_level = false);

/// Binary PLY of the cells in the map's frame, coloured: grey was there before, blue was not seen on the
/// other day, red disappeared, green appeared. `comments` are lines for the header, such as what the
/// coordinates are.
Status write_coloured(const std::filesystem::path& file, const Changes& changes,
                      const std::vector<std::string>& comments);

}  // namespace fleetmap::change
