#include "fleetmap/geometry/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fleetmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

const GeographicLib::LocalCartesian& cast(const std::shared_ptr<const void>& projection) {
  return *static_cast<const GeographicLib::LocalCartesian*>(projection.get());
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
  const double sin_lat = std::sin(0.5 * (b.latitude - a.latitude));
  const double sin_lon = std::sin(0.5 * (b.longitude - a.longitude));
  const double h = sin_lat * sin_lat + std::cos(a.latitude) * std::cos(b.latitude) * sin_lon * sin_lon;
  return 2.0 * kMeanEarthRadius * std::asin(std::sqrt(std::clamp(h, 0.0, 1.0)));
}

LocalFrame::LocalFrame(const GeoPoint& origin)
    : origin_(origin),
      projection_(std::make_shared<const GeographicLib::LocalCartesian>(
          origin.latitude / kDegree, origin.longitude / kDegree, origin.altitude)) {}

Eigen::Vector3d LocalFrame::to_enu(const GeoPoint& point) const {
  Eigen::Vector3d p;
  cast(projection_)
      .Forward(point.latitude / kDegree, point.longitude / kDegree, point.altitude, p.x(), p.y(), p.z());
  return p;
}

GeoPoint LocalFrame::to_geo(const Eigen::Vector3d& p_enu) const {
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  cast(projection_).Reverse(p_enu.x(), p_enu.y(), p_enu.z(), latitude, longitude, altitude);
  return geo_point_from_degrees(latitude, longitude, altitude);
}

Eigen::Matrix3d LocalFrame::R_enu_local(const GeoPoint& point) const {
  Eigen::Vector3d p;
  std::vector<double> rows(9);
  cast(projection_)
      .Forward(point.latitude / kDegree, point.longitude / kDegree, point.altitude, p.x(), p.y(), p.z(),
               rows);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

}  // namespace fleetmap
