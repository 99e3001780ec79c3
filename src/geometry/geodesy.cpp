#include "fleetmap/geometry/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap {
namespace {

const GeographicLib::LocalCartesian& cast(const std::shared_ptr<const void>& projection) {
  return *static_cast<const GeographicLib::LocalCartesian*>(projection.get());
}

/// Position in the Earth-centred, Earth-fixed frame of WGS84, m.
Eigen::Vector3d ecef(const GeoPoint& point) {
  constexpr double kSemiMajorAxis = 6378137.0, kFlattening = 1.0 / 298.257223563;
  constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
  const auto [sin_lat, cos_lat] = portable::sin_cos(point.latitude);
  const auto [sin_lon, cos_lon] = portable::sin_cos(point.longitude);
  const double normal = kSemiMajorAxis / std::sqrt(1.0 - kEccentricity2 * sin_lat * sin_lat);
  const double from_axis = (normal + point.altitude) * cos_lat;
  return {from_axis * cos_lon, from_axis * sin_lon,
          ((1.0 - kEccentricity2) * normal + point.altitude) * sin_lat};
}

/// East, north and up at a point, as columns in the Earth-centred frame.
Eigen::Matrix3d enu_axes(const GeoPoint& point) {
  const auto [sin_lat, cos_lat] = portable::sin_cos(point.latitude);
  const auto [sin_lon, cos_lon] = portable::sin_cos(point.longitude);
  Eigen::Matrix3d R;
  R << -sin_lon, -sin_lat * cos_lon, cos_lat * cos_lon,  //
      cos_lon, -sin_lat * sin_lon, cos_lat * sin_lon,    //
      0.0, cos_lat, sin_lat;
  return R;
}

}  // namespace

GeoPoint geo_point_from_degrees(double latitude_deg, double longitude_deg, double altitude_m) {
  return {latitude_deg * kDegree, longitude_deg * kDegree, altitude_m};
}

bool is_valid(const GeoPoint& point) {
  // Written so that NaN fails; a hair of slack for degrees converted to radians.
  return std::abs(point.latitude) <= std::numbers::pi / 2 + 1e-12 &&
         std::abs(point.longitude) <= std::numbers::pi + 1e-12 && std::isfinite(point.altitude);
}

double haversine_distance(const GeoPoint& a, const GeoPoint& b) {
  const double sin_lat = portable::sin_cos(0.5 * (b.latitude - a.latitude)).sin;
  const double sin_lon = portable::sin_cos(0.5 * (b.longitude - a.longitude)).sin;
  const double h = sin_lat * sin_lat +
                   portable::sin_cos(a.latitude).cos * portable::sin_cos(b.latitude).cos * sin_lon * sin_lon;
  return 2.0 * kMeanEarthRadius * portable::asin(std::sqrt(std::clamp(h, 0.0, 1.0)));
}

LocalFrame::LocalFrame(const GeoPoint& origin)
    : origin_(origin),
      p_ecef_origin_(ecef(origin)),
      R_ecef_enu_(enu_axes(origin)),
      projection_(std::make_shared<const GeographicLib::LocalCartesian>(
          origin.latitude / kDegree, origin.longitude / kDegree, origin.altitude)) {}

Eigen::Vector3d LocalFrame::to_enu(const GeoPoint& point) const {
  return R_ecef_enu_.transpose() * (ecef(point) - p_ecef_origin_);
}

GeoPoint LocalFrame::to_geo(const Eigen::Vector3d& p_enu) const {
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  cast(projection_).Reverse(p_enu.x(), p_enu.y(), p_enu.z(), latitude, longitude, altitude);
  return geo_point_from_degrees(latitude, longitude, altitude);
}

Eigen::Matrix3d LocalFrame::R_enu_local(const GeoPoint& point) const {
  return R_ecef_enu_.transpose() * enu_axes(point);
}

}  // namespace fleetmap
