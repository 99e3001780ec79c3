#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/ouster_input.hpp"
#include "devices/velodyne_input.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::apps {

/// DdsBus::create, with its warnings in the log.
Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config);

/// A robot's LiDAR that has no driver; null: it has one.
struct LidarInput {
  std::unique_ptr<VelodyneInput> velodyne;
  std::unique_ptr<OusterInput> ouster;
};
/// Publishes the scans of a robot whose configuration names `lidar.velodyne_port` or `lidar.ouster_port` on
/// its topic of points, and the samples of `lidar.ouster_imu_port` on that of the IMU, where its agent, a
/// recorder and rviz2 receive them as those of a driver. The bus must outlive it.
Result<LidarInput> publish_lidar(const agent::PerceptionConfig& config, bus::DdsBus& bus);

/// `wanted` (at most 8 characters), or else a name like it that no robot has.
AgentId free_name(const std::string& wanted, const std::vector<AgentId>& robots);

}  // namespace fleetmap::apps
