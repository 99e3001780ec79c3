#include "fleetmap/ros_codec/points_type.hpp"

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/ros_codec/livox_points.hpp"
#include "type_names.hpp"

namespace fleetmap::ros_codec {

std::string_view ros_name(PointsType type) {
  switch (type) {
    case PointsType::kLivoxDriver2:
      return "livox_ros_driver2/msg/CustomMsg";
    case PointsType::kLivoxDriver:
      return "livox_ros_driver/msg/CustomMsg";
    case PointsType::kLivoxInterfaces:
      return "livox_interfaces/msg/CustomMsg";
    default:
      return "sensor_msgs/msg/PointCloud2";
  }
}

std::string dds_name(PointsType type) {
  switch (type) {
    case PointsType::kLivoxDriver2:
      return type_name::kLivoxDriver2;
    case PointsType::kLivoxDriver:
      return type_name::kLivoxDriver;
    case PointsType::kLivoxInterfaces:
      return type_name::kLivoxInterfaces;
    default:
      return type_name::kPointCloud2;
  }
}

Result<PointsType> points_type(std::string_view name) {
  std::string known;
  for (const PointsType type : kPointsTypes) {
    if (ros_name(type) == name) return type;
    append_to_list(known, std::string(ros_name(type)));
  }
  return failure(std::string(name) + " is no type of points that is read; expected one of " + known);
}

Bytes encode_points(const sensor::Scan& scan, PointsType type, std::string_view frame_id) {
  return type == PointsType::kPointCloud2 ? encode(scan, frame_id) : encode_livox(scan, frame_id);
}

Result<DecodedScan> decode_points(ByteView cdr, PointsType type) {
  return type == PointsType::kPointCloud2 ? decode_scan(cdr) : decode_livox(cdr);
}

}  // namespace fleetmap::ros_codec
