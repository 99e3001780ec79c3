#include "fleetmap/monitor/fleet_drawing.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "fleetmap/graph/located_nodes.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;

constexpr std::array<std::uint32_t, 10> kRobotColors = {0x2f7de1, 0xe8743b, 0x1fa774, 0xd1477a, 0xb58900,
                                                        0x7d5bd6, 0x1598a8, 0x8c6243, 0x5f7488, 0x7a8b2a};

constexpr std::array<std::pair<AlignmentStatus, std::uint32_t>, 7> kStatusColors = {
    {{AlignmentStatus::used, 0x12a150},
     {AlignmentStatus::against_gps, 0xe0912f},
     {AlignmentStatus::against_others, 0xe0912f},
     {AlignmentStatus::undecided, 0xe3c94a},
     {AlignmentStatus::quarantined, 0xd92d3a},
     {AlignmentStatus::waiting, 0x8b98a5},
     {AlignmentStatus::invalid, 0xd92d3a}}};

}  // namespace

Stamp newest_stamp(const FleetView& view) {
  Stamp newest{};
  for (const graph::Node& node : view.nodes) newest = std::max(newest, node.stamp);
  return newest;
}

std::map<AgentId, LastNode> last_nodes(const FleetView& view) {
  const auto floating = graph::not_georeferenced(view.nodes, view.placement.components);
  std::map<AgentId, LastNode> last;
  for (const graph::Node& node : view.nodes) {
    const auto placed = view.placement.T_enu_node.find(node.id);
    if (placed == view.placement.T_enu_node.end()) continue;
    const auto [robot, first] = last.try_emplace(node.id.agent);
    if (!first && std::pair(node.stamp, node.id) < std::pair(robot->second.stamp, robot->second.id)) continue;
    robot->second = {.id = node.id,
                     .stamp = node.stamp,
                     .T_enu_node = placed->second,
                     .georeferenced = std::ranges::find(floating, node.frame()) == floating.end(),
                     .covariance = std::nullopt};
  }
  for (auto& [robot, node] : last) {
    const auto C = view.placement.covariance.find(node.id);
    if (C != view.placement.covariance.end()) node.covariance = C->second;
  }
  return last;
}

std::map<AgentId, std::uint32_t> robot_colors(const FleetView& view) {
  std::map<AgentId, std::uint32_t> colors;
  std::size_t place = 0;
  for (const AgentId& robot : robots_of(view)) colors[robot] = kRobotColors[place++ % kRobotColors.size()];
  return colors;
}

std::map<graph::FrameId, std::vector<Eigen::Vector3d>> tracks_of(const FleetView& view) {
  std::map<graph::FrameId, std::map<NodeId, Eigen::Vector3d>> in_order;
  for (const graph::Node& node : view.nodes) {
    const auto placed = view.placement.T_enu_node.find(node.id);
    if (placed != view.placement.T_enu_node.end())
      in_order[node.frame()][node.id] = placed->second.translation();
  }
  std::map<graph::FrameId, std::vector<Eigen::Vector3d>> tracks;
  for (const auto& [frame, nodes] : in_order)
    for (const auto& [id, point] : nodes) tracks[frame].push_back(point);
  return tracks;
}

std::vector<AlignmentLines> alignment_lines(const FleetView& view) {
  const Outcomes outcomes = outcomes_of(view);
  std::map<AlignmentStatus, std::vector<Eigen::Vector3d>> points;
  for (const graph::Alignment& alignment : view.alignments) {
    const auto i = view.placement.T_enu_node.find(alignment.i),
               j = view.placement.T_enu_node.find(alignment.j);
    if (i == view.placement.T_enu_node.end() || j == view.placement.T_enu_node.end()) continue;
    const auto outcome = outcomes.find({alignment.computed_by, alignment.seq});
    std::vector<Eigen::Vector3d>& ends =
        points[outcome == outcomes.end() ? AlignmentStatus::undecided : outcome->second];
    ends.push_back(i->second.translation());
    ends.push_back(j->second.translation());
  }
  std::vector<AlignmentLines> lines;
  for (const auto& [status, rgb] : kStatusColors) lines.push_back({status, rgb, std::move(points[status])});
  return lines;
}

}  // namespace fleetmap::monitor
