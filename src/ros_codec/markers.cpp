#include "fleetmap/ros_codec/markers.hpp"

#include "fleetmap/bus/cdr.hpp"
#include "ros_geometry.hpp"
#include "visualization_msgs.h"

namespace fleetmap::ros_codec {
namespace {

using visualization_msgs::msg::dds_::Marker_;

constexpr std::int32_t kDeleteAll = 3;

std_msgs::msg::dds_::ColorRGBA_ color_of(std::uint32_t rgb) {
  const auto share = [rgb](int shift) { return static_cast<float>((rgb >> shift) & 0xff) / 255.0f; };
  std_msgs::msg::dds_::ColorRGBA_ color;
  color.r(share(16));
  color.g(share(8));
  color.b(share(0));
  color.a(1.0f);
  return color;
}

Marker_ to_ros(const Marker& marker) {
  Marker_ out;
  out.ns(marker.group);
  out.id(marker.id);
  out.type(static_cast<std::int32_t>(marker.type));
  out.pose(ros_codec::to_ros(marker.T_frame_marker));
  out.scale(ros_codec::to_ros(marker.scale));
  out.color(color_of(marker.rgb));
  for (const Eigen::Vector3d& point : marker.points) out.points().push_back(point_to_ros(point));
  out.text(marker.text);
  return out;
}

}  // namespace

Bytes encode(const MarkersMsg& markers) {
  visualization_msgs::msg::dds_::MarkerArray_ out;
  const std_msgs::msg::dds_::Header_ head = header(markers.stamp, markers.frame);
  Marker_& clear = out.markers().emplace_back();
  clear.header(head);
  clear.action(kDeleteAll);
  clear.pose(ros_codec::to_ros(Pose(Pose::Identity())));
  for (const Marker& marker : markers.markers) out.markers().emplace_back(to_ros(marker)).header(head);
  return bus::to_cdr(out);
}

}  // namespace fleetmap::ros_codec
