#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::ros_codec {

/// Points of a map, as a PointCloud2 with x, y, z (float32), intensity (float32) and robot (uint16).
struct MapPoints {
  struct Point {
    Eigen::Vector3f p = Eigen::Vector3f::Zero();  ///< m, in `frame`
    float intensity = 0.0f;
    std::uint16_t robot = 0;  ///< its place in the sorted fleet
  };
  Stamp stamp;
  std::string frame;
  std::vector<Point> points;
};
Bytes encode(const MapPoints& map);

}  // namespace fleetmap::ros_codec
