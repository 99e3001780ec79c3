#pragma once

#include <Eigen/Core>
#include <memory>

#include "fleetmap/core/result.hpp"

namespace fleetmap {

/// WGS84 position. Radians inside the program; degrees only in files and on screens.
struct GeoPoint {
  double latitude = 0.0;   ///< rad, [-pi/2, pi/2]
  double longitude = 0.0;  ///< rad, [-pi, pi]
  double altitude = 0.0;   ///< m above the ellipsoid
  bool operator==(const GeoPoint&) const = default;
};

GeoPoint geo_point_from_degrees(double latitude_deg, double longitude_deg, double altitude_m);
/// Finite, and within the ranges above.
bool is_valid(const GeoPoint& point);

/// Great-circle distance in metres on the sphere of the mean Earth radius (altitude ignored); the metric of
/// the global ball tree (paper, Alg. 1). Accurate from millimetres to antipodes.
double haversine_distance(const GeoPoint& a, const GeoPoint& b);
inline constexpr double kMeanEarthRadius = 6371008.7714;  ///< m, IUGG R1

/// East-north-up frame at an origin on the ellipsoid. From geographic positions to it every processor
/// computes the same bits, since robots place nodes by it; back again it is GeographicLib::LocalCartesian.
class LocalFrame {
 public:
  explicit LocalFrame(const GeoPoint& origin);
  const GeoPoint& origin() const { return origin_; }
  Eigen::Vector3d to_enu(const GeoPoint& point) const;  ///< m
  GeoPoint to_geo(const Eigen::Vector3d& p_enu) const;
  /// Rotation from the ENU axes at `point` to those of this frame (they differ by the curvature of the
  /// Earth).
  Eigen::Matrix3d R_enu_local(const GeoPoint& point) const;

 private:
  GeoPoint origin_;
  Eigen::Vector3d p_ecef_origin_;
  Eigen::Matrix3d R_ecef_enu_;
  std::shared_ptr<const void> projection_;
};

}  // namespace fleetmap
