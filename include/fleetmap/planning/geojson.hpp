#pragma once

#include <filesystem>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/mission.hpp"
#include "fleetmap/planning/mission_config.hpp"

namespace fleetmap::planning {

/// Coordinates of a mission's file.
enum class FileFrame {
  kWgs84,  ///< [longitude, latitude] in degrees (RFC 7946)
  kEnu,    ///< [east, north] in metres from the site's origin; member "frame": "enu"
};

struct GeoJsonLimits {
  std::size_t file_bytes = 64u << 20;
  /// m; a waypoint farther from the site's origin is taken for a mistake, not for a large site.
  double reach = 10'000.0;
};

/// A mission from a GeoJSON FeatureCollection: each LineString is a row (property "row" or "id" numbers it,
/// else it gets the next number), each Polygon a keep-out (its outer ring). MultiLineString and MultiPolygon
/// stand for their parts; Points are ignored. WGS84 degrees unless a member "frame" (of the collection or its
/// "properties") says "enu". Fails with file, line or feature, what is wrong and the remedy.
Result<Mission> read_geojson(const std::filesystem::path& file, const LocalFrame& site,
                             const GeoJsonLimits& limits = {});
/// The same from text; problems are reported under `name`.
Result<Mission> parse_geojson(const std::string& text, const std::string& name, const LocalFrame& site,
                              const GeoJsonLimits& limits = {});

/// Reading it again gives the same mission to a micrometre (ENU) or 0.1 mm (WGS84; 9 decimals of a degree).
std::string to_geojson(const Mission& mission, const LocalFrame& site, FileFrame frame = FileFrame::kWgs84);
Status write_geojson(const std::filesystem::path& file, const Mission& mission, const LocalFrame& site,
                     FileFrame frame = FileFrame::kWgs84);

/// What a site brings along for any mission on it.
struct SitePlan {
  std::vector<Lane> lanes;        ///< sorted across the site; empty if unknown
  std::vector<KeepOut> keep_out;  ///< what stands there
  std::optional<SiteBounds> bounds;
};

/// The mission that `config.waypoints` asks for, on this site: rows of its lanes or of a GeoJSON file, with
/// the site's keep-outs besides the file's. Fails, with the remedy, if a waypoint lies outside the bounds or
/// the site knows no lanes.
Result<Mission> make_mission(const MissionConfig& config, const SitePlan& plan, const LocalFrame& site);

}  // namespace fleetmap::planning
