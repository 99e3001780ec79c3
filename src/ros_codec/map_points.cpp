#include "fleetmap/ros_codec/map_points.hpp"

#include <array>
#include <bit>
#include <cstring>

#include "fleetmap/bus/cdr.hpp"
#include "point_datatype.hpp"
#include "ros_geometry.hpp"
#include "sensor_msgs.h"

namespace fleetmap::ros_codec {
namespace {

constexpr std::size_t kRobotAt = 16, kPointBytes = 20;  // floats stay aligned

struct MapField {
  const char* name;
  std::uint32_t offset;
  PointDatatype datatype;
};
constexpr std::array<MapField, 5> kFields{{{"x", 0, kFloat32},
                                           {"y", 4, kFloat32},
                                           {"z", 8, kFloat32},
                                           {"intensity", 12, kFloat32},
                                           {"robot", kRobotAt, kUint16}}};

}  // namespace

Bytes encode(const MapPoints& map) {
  sensor_msgs::msg::dds_::PointCloud2_ out;
  out.header(header(map.stamp, map.frame));
  out.height(1);
  out.width(static_cast<std::uint32_t>(map.points.size()));
  for (const MapField& field : kFields) {
    sensor_msgs::msg::dds_::PointField_& one = out.fields().emplace_back();
    one.name(field.name);
    one.offset(field.offset);
    one.datatype(field.datatype);
    one.count(1);
  }
  out.is_bigendian(std::endian::native == std::endian::big);
  out.point_step(kPointBytes);
  out.row_step(static_cast<std::uint32_t>(kPointBytes * map.points.size()));
  out.is_dense(true);
  std::vector<std::uint8_t> data(kPointBytes * map.points.size());
  std::uint8_t* at = data.data();
  for (const MapPoints::Point& point : map.points) {
    const std::array<float, 4> values{point.p.x(), point.p.y(), point.p.z(), point.intensity};
    std::memcpy(at, values.data(), kRobotAt);
    std::memcpy(at + kRobotAt, &point.robot, sizeof point.robot);
    at += kPointBytes;
  }
  out.data(std::move(data));
  return bus::to_cdr(out);
}

}  // namespace fleetmap::ros_codec
