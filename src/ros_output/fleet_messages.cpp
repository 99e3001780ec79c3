#include "fleetmap/ros_output/fleet_messages.hpp"

#include <algorithm>
#include <utility>

#include "fleetmap/monitor/fleet_drawing.hpp"
#include "fleetmap/ros_output/pose_messages.hpp"

namespace fleetmap::ros_output {
namespace {

using ros_codec::Marker;

constexpr double kLineWidth = 0.1, kNodeDiameter = 0.5, kTextHeight = 1.0;  // m
const Eigen::Vector3d kArrow(1.2, 0.3, 0.3);                                // m: length, width, height

/// Markers of one group are numbered.
class Drawing {
 public:
  Marker& add(const std::string& group, Marker::Type type, std::uint32_t rgb, double size) {
    Marker& marker = markers_.emplace_back();
    marker.group = group;
    marker.id = static_cast<std::int32_t>(
        std::ranges::count(markers_.begin(), markers_.end() - 1, group, &Marker::group));
    marker.type = type;
    marker.rgb = rgb;
    marker.scale.setConstant(size);
    return marker;
  }
  std::vector<Marker> take() { return std::move(markers_); }

 private:
  std::vector<Marker> markers_;
};

void add_tracks(const monitor::FleetView& view, const std::map<AgentId, std::uint32_t>& colors,
                Drawing& drawing) {
  for (const auto& [frame, track] : monitor::tracks_of(view)) {
    const std::uint32_t rgb = colors.at(frame.agent);
    // A line strip of one point is an error to RViz.
    if (track.size() > 1) drawing.add("tracks", Marker::Type::line_strip, rgb, kLineWidth).points = track;
    drawing.add("nodes", Marker::Type::sphere_list, rgb, kNodeDiameter).points = track;
  }
}

void add_others(const monitor::FleetView& view, const std::map<AgentId, std::uint32_t>& colors,
                Drawing& drawing) {
  for (const auto& [robot, last] : monitor::last_nodes(view)) {
    if (robot == view.self) continue;
    Marker& arrow = drawing.add("robots", Marker::Type::arrow, colors.at(robot), 1.0);
    arrow.scale = kArrow;
    arrow.T_frame_marker = last.T_enu_node;
    Marker& name = drawing.add("robots", Marker::Type::text, colors.at(robot), kTextHeight);
    name.T_frame_marker.translation() =
        last.T_enu_node.translation() + 1.5 * kTextHeight * Eigen::Vector3d::UnitZ();
    name.text = robot.str();
  }
}

}  // namespace

monitor::FleetView view_of(const graph::PlacedFleet& fleet, const AgentId& self) {
  monitor::FleetView view;
  view.self = self;
  view.origin = fleet.origin;
  view.nodes = fleet.nodes;
  view.alignments = fleet.alignments;
  view.placement = fleet.placement;
  return view;
}

ros_codec::PathMsg path_message(const monitor::FleetView& view) {
  ros_codec::PathMsg path{kMapFrame, {}};
  for (const graph::Node& node : view.nodes) {
    const auto placed = view.placement.T_enu_node.find(node.id);
    if (node.id.agent == view.self && placed != view.placement.T_enu_node.end())
      path.poses.push_back({node.stamp, placed->second});
  }
  std::ranges::stable_sort(path.poses, {}, &ros_codec::PathMsg::StampedPose::stamp);
  return path;
}

ros_codec::MarkersMsg markers_message(const monitor::FleetView& view) {
  Drawing drawing;
  const auto colors = monitor::robot_colors(view);
  add_tracks(view, colors, drawing);
  for (monitor::AlignmentLines& lines : monitor::alignment_lines(view)) {
    if (lines.points.empty()) continue;
    const std::string group = std::string("alignments/") + graph::to_string(lines.status);
    drawing.add(group, Marker::Type::line_list, lines.rgb, kLineWidth).points = std::move(lines.points);
  }
  add_others(view, colors, drawing);
  return {monitor::newest_stamp(view), kMapFrame, drawing.take()};
}

}  // namespace fleetmap::ros_output
