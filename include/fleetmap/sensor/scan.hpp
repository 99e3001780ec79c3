#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// One return of a LiDAR.
struct ScanPoint {
  Eigen::Vector3f position;  ///< m, in the LiDAR frame at the moment of firing (not motion compensated)
  float intensity = 0.0f;    ///< as the device gives it
  float time = 0.0f;         ///< s after Scan::stamp (may be negative); meaningful if Scan::has_time
  std::uint16_t ring = 0;    ///< laser index; meaningful if Scan::has_ring
};

/// One revolution (or frame) of a LiDAR, in the order in which the device gave the points.
struct Scan {
  Stamp stamp;
  bool has_time = false;
  bool has_ring = false;
  std::vector<ScanPoint> points;
};

}  // namespace fleetmap::sensor
