#include "fleetmap/ros_output/map_points.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/monitor/fleet_drawing.hpp"
#include "fleetmap/ros_output/pose_messages.hpp"

namespace fleetmap::ros_output {
namespace {

float intensity_of(const cloud::PointCloud& cloud, std::size_t k) {
  return cloud.has_intensities() ? cloud.intensities[k] : 0.0f;
}

}  // namespace

MapBuilder::MapBuilder(const RosOutputConfig& config, std::vector<AgentId> fleet)
    : config_(config), fleet_(std::move(fleet)), voxel_(config.map_voxel) {
  std::ranges::sort(fleet_);
}

std::uint16_t MapBuilder::number_of(const AgentId& robot) const {
  return static_cast<std::uint16_t>(std::ranges::find(fleet_, robot) - fleet_.begin());
}

void MapBuilder::add(const NodeId& id, const cloud::PointCloud& submap) {
  submaps_.insert_or_assign(id, cloud::voxel_downsample(submap, static_cast<float>(config_.map_voxel)));
}

ros_codec::MapPoints MapBuilder::submap(const graph::Node& node, const monitor::FleetView& view) const {
  ros_codec::MapPoints points{node.stamp, kMapFrame, {}};
  const auto held = submaps_.find(node.id);
  const auto placed = view.placement.T_enu_node.find(node.id);
  if (held == submaps_.end() || placed == view.placement.T_enu_node.end()) return points;
  const std::uint16_t robot = number_of(node.id.agent);
  const cloud::PointCloud on_map = cloud::transformed(held->second, placed->second);
  for (std::size_t k = 0; k < on_map.size(); ++k)
    points.points.push_back({on_map.points[k], intensity_of(on_map, k), robot});
  return points;
}

ros_codec::MapPoints MapBuilder::whole(const monitor::FleetView& view) {
  for (;; voxel_ *= std::numbers::sqrt2) {
    cloud::VoxelMerger merger(static_cast<float>(voxel_));
    std::vector<std::uint16_t> robot_of;
    for (const auto& [id, submap] : submaps_) {
      const auto placed = view.placement.T_enu_node.find(id);
      if (placed == view.placement.T_enu_node.end()) continue;
      const std::size_t more = merger.add(cloud::transformed(submap, placed->second));
      robot_of.insert(robot_of.end(), more, number_of(id.agent));
      if (merger.voxels() > config_.map_points) break;
    }
    if (merger.voxels() > config_.map_points) continue;
    const cloud::PointCloud merged = merger.cloud();
    ros_codec::MapPoints map{monitor::newest_stamp(view), kMapFrame, {}};
    map.points.reserve(merged.size());
    for (std::size_t k = 0; k < merged.size(); ++k)
      map.points.push_back({merged.points[k], intensity_of(merged, k), robot_of[k]});
    // A step halves the points of a surface, so the next map fits as well.
    if (merged.size() < config_.map_points / 4)
      voxel_ = std::max(config_.map_voxel, voxel_ / std::numbers::sqrt2);
    return map;
  }
}

}  // namespace fleetmap::ros_output
