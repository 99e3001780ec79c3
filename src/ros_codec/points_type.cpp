#include "fleetmap/ros_codec/points_type.hpp"

#include "cdr_header.hpp"
#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/ros_codec/livox_points.hpp"
#include "ros_time.hpp"
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

Result<Stamp> stamp_of_points(ByteView cdr, PointsType type) {
  const std::string name = dds_name(type);
  if (auto status = bus::check_encapsulation(cdr, name.c_str()); !status)
    return tl::unexpected(status.error());
  if (cdr.size() < bus::kEncapsulationBytes + kStampBytes) return failure(name + ": ends within its header");
  builtin_interfaces::msg::dds_::Time_ time;
  time.sec(static_cast<std::int32_t>(header_number(cdr, bus::kEncapsulationBytes)));
  time.nanosec(header_number(cdr, bus::kEncapsulationBytes + 4));
  return from_ros(time, name.c_str());
}

}  // namespace fleetmap::ros_codec
