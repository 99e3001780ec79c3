#pragma once

#include <cstdint>

namespace fleetmap::ros_codec {

/// The type of a field of sensor_msgs/PointCloud2, as sensor_msgs/PointField numbers them.
enum PointDatatype : std::uint8_t { kInt8 = 1, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

}  // namespace fleetmap::ros_codec
