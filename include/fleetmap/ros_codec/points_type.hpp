#pragma once

#include <array>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::ros_codec {

/// A type of message that holds a scan.
enum class PointsType { kPointCloud2, kLivoxDriver2, kLivoxDriver, kLivoxInterfaces };
inline constexpr std::array kPointsTypes{PointsType::kPointCloud2, PointsType::kLivoxDriver2,
                                         PointsType::kLivoxDriver, PointsType::kLivoxInterfaces};

/// ROS 2's name: "livox_ros_driver2/msg/CustomMsg".
std::string_view ros_name(PointsType type);
/// The name on the wire: "livox_ros_driver2::msg::dds_::CustomMsg_".
std::string dds_name(PointsType type);
/// By ROS 2's name. Fails with the names that exist.
Result<PointsType> points_type(std::string_view ros_name);

Bytes encode_points(const sensor::Scan& scan, PointsType type, std::string_view frame_id = "lidar");
Result<DecodedScan> decode_points(ByteView cdr, PointsType type);
/// The header's stamp of a message of points, without reading anything else.
Result<Stamp> stamp_of_points(ByteView cdr, PointsType type);

}  // namespace fleetmap::ros_codec
