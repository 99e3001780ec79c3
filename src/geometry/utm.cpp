#include "fleetmap/geometry/utm.hpp"

#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap {
std::optional<UtmZone> utm_zone_at(const GeoPoint& point) {
  if (!is_valid(point)) return std::nullopt;
  const int number = GeographicLib::UTMUPS::StandardZone(point.latitude / kDegree, point.longitude / kDegree);
  if (number < GeographicLib::UTMUPS::MINUTMZONE) return std::nullopt;
  return UtmZone{number, point.latitude >= 0.0};
}

std::optional<UtmZone> utm_zone_of_epsg(int code) {
  for (const bool north : {true, false}) {
    const UtmZone first{1, north}, last{60, north};
    if (code >= first.epsg() && code <= last.epsg()) return UtmZone{code - first.epsg() + 1, north};
  }
  return std::nullopt;
}

std::optional<UtmPoint> to_utm(const GeoPoint& point, const UtmZone& zone) {
  if (!is_valid(point)) return std::nullopt;
  const double longitude = point.longitude / kDegree;
  const double from_meridian = std::remainder(longitude - zone.central_meridian_deg(), 360.0);
  if (std::abs(from_meridian) > kUtmReachDeg) return std::nullopt;
  double x = 0.0, y = 0.0, convergence = 0.0, scale = 1.0;
  GeographicLib::TransverseMercator::UTM().Forward(zone.central_meridian_deg(), point.latitude / kDegree,
                                                   longitude, x, y, convergence, scale);
  return UtmPoint{{x + kUtmFalseEasting, y + zone.false_northing()}, scale};
}

}  // namespace fleetmap
