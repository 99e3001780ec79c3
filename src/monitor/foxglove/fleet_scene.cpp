#include "fleet_scene.hpp"

#include <map>
#include <utility>

#include "fleetmap/monitor/fleet_drawing.hpp"
#include "scene_update.hpp"

namespace fleetmap::monitor::foxglove {

Bytes trajectories_message(const FleetView& view) {
  const Stamp stamp = newest_stamp(view);
  const auto colors = robot_colors(view);
  std::map<AgentId, Entity> of_robot;
  for (const auto& [robot, rgb] : colors) {
    Entity& entity = of_robot[robot];
    entity.id = robot.str();
    entity.stamp = stamp;
  }
  for (const auto& [frame, track] : tracks_of(view)) {
    Entity& entity = of_robot[frame.agent];
    Line line;
    line.color = color_of(colors.at(frame.agent));
    for (const Eigen::Vector3d& point : track)
      entity.spheres.push_back({.centre = point, .color = line.color});
    line.points = track;
    entity.lines.push_back(std::move(line));
  }
  std::vector<Entity> entities;
  for (auto& [robot, entity] : of_robot) entities.push_back(std::move(entity));
  return scene_update(entities);
}

Bytes alignments_message(const FleetView& view) {
  const Stamp stamp = newest_stamp(view);
  std::vector<Entity> entities;
  for (AlignmentLines& of_status : alignment_lines(view)) {
    Entity& entity = entities.emplace_back();
    entity.id = graph::to_string(of_status.status);
    entity.stamp = stamp;
    if (of_status.points.empty()) continue;
    Line line;
    line.type = LineType::list;
    line.color = color_of(of_status.rgb);
    line.points = std::move(of_status.points);
    entity.lines.push_back(std::move(line));
  }
  return scene_update(entities);
}

}  // namespace fleetmap::monitor::foxglove
