#pragma once

#include <Eigen/Core>
#include <optional>

#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap {

/// A zone of the Universal Transverse Mercator system on WGS84.
struct UtmZone {
  int number = 31;  ///< 1 to 60
  bool north = true;
  bool operator==(const UtmZone&) const = default;

  /// EPSG:32601 to 32660 north, EPSG:32701 to 32760 south.
  int epsg() const { return (north ? 32600 : 32700) + number; }
  int central_meridian_deg() const { return 6 * number - 183; }
  double false_northing() const { return north ? 0.0 : 10'000'000.0; }  ///< m
};
inline constexpr double kUtmFalseEasting = 500'000.0;  ///< m

/// The standard zone of a place, with the exceptions of Norway and Svalbard. Empty north of 84 and south of
/// -80 degrees, where UTM ends.
std::optional<UtmZone> utm_zone_at(const GeoPoint& point);
/// Empty for any code but those of UtmZone::epsg().
std::optional<UtmZone> utm_zone_of_epsg(int code);

/// A position on the map of a UTM zone.
struct UtmPoint {
  Eigen::Vector2d p_utm;  ///< easting and northing, m
  double scale = 1.0;     ///< of lengths on the map over those on the ellipsoid
};
/// The place in a zone that need not be its own, by Krueger's series to the sixth order
/// (GeographicLib::TransverseMercator): within 5 nm to kUtmReachDeg of the central meridian. Empty beyond it.
std::optional<UtmPoint> to_utm(const GeoPoint& point, const UtmZone& zone);
inline constexpr double kUtmReachDeg = 30.0;

}  // namespace fleetmap
