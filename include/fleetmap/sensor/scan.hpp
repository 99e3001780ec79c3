#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// One return of a LiDAR.
struct ScanPoint {
  Eigen::Vector3f position;  ///< m, in the LiDAR frame at the moment of firing (not motion compensated)
  float intensity = 0.0f;    ///< in the device's units
  float time = 0.0f;         ///< s after Scan::stamp (may be negative); meaningful if Scan::has_time
  std::uint16_t ring = 0;    ///< laser index; meaningful if Scan::has_ring
};

/// One revolution (or frame) of a LiDAR, in the device's order of points.
struct Scan {
  Stamp stamp;
  bool has_time = false;
  bool has_ring = false;
  std::vector<ScanPoint> points;
};

/// The time at which the last point was fired, by the points' times; the stamp itself without such times.
inline Stamp end_of(const Scan& scan) {
  float last = 0.0f;
  if (scan.has_time) {
    for (const ScanPoint& point : scan.points) last = std::max(last, point.time);
  }
  return scan.stamp + from_seconds(static_cast<double>(last));
}

/// Time between the first and the last firing; 0 without point times.
inline Duration sweep_of(const Scan& scan) {
  if (!scan.has_time || scan.points.empty()) return Duration::zero();
  const auto [first, last] = std::ranges::minmax_element(scan.points, {}, &ScanPoint::time);
  return from_seconds(static_cast<double>(last->time - first->time));
}

}  // namespace fleetmap::sensor
