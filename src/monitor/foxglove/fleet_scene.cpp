#include "fleet_scene.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "scene_update.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using graph::AlignmentStatus;

/// Those of the page, by the robot's place in the fleet.
constexpr std::array<std::uint32_t, 10> kRobotColors = {0x2f7de1, 0xe8743b, 0x1fa774, 0xd1477a, 0xb58900,
                                                        0x7d5bd6, 0x1598a8, 0x8c6243, 0x5f7488, 0x7a8b2a};

struct StatusColor {
  AlignmentStatus status;
  std::uint32_t rgb;
};
constexpr std::array<StatusColor, 7> kStatusColors = {{{AlignmentStatus::used, 0x12a150},
                                                       {AlignmentStatus::against_gps, 0xe0912f},
                                                       {AlignmentStatus::against_others, 0xe0912f},
                                                       {AlignmentStatus::undecided, 0xe3c94a},
                                                       {AlignmentStatus::quarantined, 0xd92d3a},
                                                       {AlignmentStatus::waiting, 0x8b98a5},
                                                       {AlignmentStatus::invalid, 0xd92d3a}}};

/// Placed nodes by odometry frame, each in the order in which they were made.
std::map<graph::FrameId, std::map<NodeId, Eigen::Vector3d>> tracks_of(const FleetView& view) {
  std::map<graph::FrameId, std::map<NodeId, Eigen::Vector3d>> tracks;
  for (const graph::Node& node : view.nodes) {
    const auto placed = view.placement.T_enu_node.find(node.id);
    if (placed != view.placement.T_enu_node.end())
      tracks[node.frame()][node.id] = placed->second.translation();
  }
  return tracks;
}

}  // namespace

Stamp newest_stamp(const FleetView& view) {
  Stamp newest{};
  for (const graph::Node& node : view.nodes) newest = std::max(newest, node.stamp);
  return newest;
}

Bytes trajectories_message(const FleetView& view) {
  const Stamp stamp = newest_stamp(view);
  std::map<AgentId, Entity> of_robot;
  for (const AgentId& robot : robots_of(view)) {
    Entity& entity = of_robot[robot];
    entity.id = robot.str();
    entity.stamp = stamp;
  }
  std::size_t place = 0;
  std::map<AgentId, Color> colors;
  for (const auto& [robot, entity] : of_robot)
    colors[robot] = color_of(kRobotColors[place++ % kRobotColors.size()]);
  for (const auto& [frame, track] : tracks_of(view)) {
    Entity& entity = of_robot[frame.agent];
    Line line;
    line.color = colors[frame.agent];
    for (const auto& [id, point] : track) {
      line.points.push_back(point);
      entity.spheres.push_back({.centre = point, .color = line.color});
    }
    entity.lines.push_back(std::move(line));
  }
  std::vector<Entity> entities;
  for (auto& [robot, entity] : of_robot) entities.push_back(std::move(entity));
  return scene_update(entities);
}

Bytes alignments_message(const FleetView& view) {
  const Stamp stamp = newest_stamp(view);
  const Outcomes outcomes = outcomes_of(view);
  std::map<AlignmentStatus, Line> lines;
  for (const graph::Alignment& alignment : view.alignments) {
    const auto i = view.placement.T_enu_node.find(alignment.i),
               j = view.placement.T_enu_node.find(alignment.j);
    if (i == view.placement.T_enu_node.end() || j == view.placement.T_enu_node.end()) continue;
    const auto outcome = outcomes.find({alignment.computed_by, alignment.seq});
    Line& line = lines[outcome == outcomes.end() ? AlignmentStatus::undecided : outcome->second];
    line.points.push_back(i->second.translation());
    line.points.push_back(j->second.translation());
  }
  std::vector<Entity> entities;
  for (const auto& [status, rgb] : kStatusColors) {
    Entity& entity = entities.emplace_back();
    entity.id = graph::to_string(status);
    entity.stamp = stamp;
    const auto found = lines.find(status);
    if (found == lines.end()) continue;
    found->second.type = LineType::list;
    found->second.color = color_of(rgb);
    entity.lines.push_back(std::move(found->second));
  }
  return scene_update(entities);
}

}  // namespace fleetmap::monitor::foxglove
