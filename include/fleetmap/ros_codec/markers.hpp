#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::ros_codec {

/// A visualization_msgs/Marker.
struct Marker {
  enum class Type : std::int32_t { arrow = 0, line_strip = 4, line_list = 5, sphere_list = 7, text = 9 };
  std::string group;  ///< its namespace; with the id it names the marker
  std::int32_t id = 0;
  Type type = Type::line_strip;
  Pose T_frame_marker = Pose::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< m; of lines x: their width; of text z: its height
  std::uint32_t rgb = 0;                            ///< 0xrrggbb
  std::vector<Eigen::Vector3d> points;              ///< m, in the marker's frame
  std::string text;
};

/// A visualization_msgs/MarkerArray that replaces all markers sent before.
struct MarkersMsg {
  Stamp stamp;
  std::string frame;
  std::vector<Marker> markers;
};
Bytes encode(const MarkersMsg& markers);

}  // namespace fleetmap::ros_codec
