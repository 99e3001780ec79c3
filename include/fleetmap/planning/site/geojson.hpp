#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/site/drawing_limits.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// A site's drawing from a GeoJSON FeatureCollection:
/// - LineString: a row (property "row" or "id" numbers it, else it gets the next number);
/// - Polygon: a keep-out (its outer ring), or with property "boundary": true the site's boundary;
/// - Point with property "start": true or a robot's name: where robots set out; other points are ignored;
/// - LineString with property "route" (of a plan that was written): ignored.
/// MultiLineString and MultiPolygon stand for their parts. WGS84 degrees unless a member "frame" (of the
/// collection or its "properties") says "enu". Fails with file, line or feature, the problem and the remedy.
Result<Mission> read_geojson(const std::filesystem::path& file, const LocalFrame& site,
                             const DrawingLimits& limits = {});
/// The same from text; problems are reported under `name`.
Result<Mission> parse_geojson(const std::string& text, const std::string& name, const LocalFrame& site,
                              const DrawingLimits& limits = {});

/// The first position of a file in WGS84, at height 0: an origin for a site that names none. Nothing for a
/// file in ENU or without positions; parse_geojson says what is wrong with the latter.
std::optional<GeoPoint> first_position(const std::string& text);

}  // namespace fleetmap::planning
