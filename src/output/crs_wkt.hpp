#pragma once

#include <optional>
#include <string>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/utm.hpp"

/// Coordinate reference systems as "well-known text" of OGC 01-009, which LAS 1.4 requires.
namespace fleetmap::output {

/// A zone with heights in metres above the ellipsoid of WGS84, or above `geoid`, if it names one as Geoid
/// does. EPSG's vertical system is named where the geoid has one (EGM84, EGM96, EGM2008).
std::string utm_wkt(const UtmZone& zone, const std::optional<std::string>& geoid);

/// The east-north-up frame at `origin`; without one a local frame at an unknown place.
std::string local_wkt(const std::optional<GeoPoint>& origin, bool above_sea_level = false);

/// "39.000000000, -3.000000000 deg, 600.000 m above the WGS 84 ellipsoid", or "above mean sea level as GPS
/// gave it"
std::string origin_text(const GeoPoint& origin, bool above_sea_level = false);

}  // namespace fleetmap::output
