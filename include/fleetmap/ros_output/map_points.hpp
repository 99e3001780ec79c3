#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/ros_codec/map_points.hpp"
#include "fleetmap/ros_output/ros_output_config.hpp"

namespace fleetmap::ros_output {

/// The submaps of a fleet, thinned, and the map that they make when they are placed. Submaps never change, so
/// each is added once, and a map of other poses needs no submap again.
class MapBuilder {
 public:
  /// `fleet`: all robots that are configured; a robot's number is its place by name, and their count that of
  /// any other.
  MapBuilder(const RosOutputConfig& config, std::vector<AgentId> fleet);

  bool holds(const NodeId& id) const { return submaps_.contains(id); }
  /// `submap` is in the node's frame.
  void add(const NodeId& id, const cloud::PointCloud& submap);
  /// A submap that was added, at its node's place in the view; none where the node is not placed.
  ros_codec::MapPoints submap(const graph::Node& node, const monitor::FleetView& view) const;
  /// All submaps that were added, a point a voxel, at most as many points as configured. Begins with the
  /// voxels of the last one.
  ros_codec::MapPoints whole(const monitor::FleetView& view);
  double voxel() const { return voxel_; }  ///< m, of the next map at first

 private:
  std::uint16_t number_of(const AgentId& robot) const;

  RosOutputConfig config_;
  std::vector<AgentId> fleet_;  ///< by name
  double voxel_;                ///< m
  std::map<NodeId, cloud::PointCloud> submaps_;
};

}  // namespace fleetmap::ros_output
