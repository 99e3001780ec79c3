#include "live_bus.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {

Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config) {
  auto made = bus::DdsBus::create(config);
  if (!made) return made;
  for (const std::string& warning : (*made)->warnings()) spdlog::warn("{}: {}", config.agent.str(), warning);
  return made;
}

Result<std::unique_ptr<VelodyneInput>> publish_velodyne(const agent::PerceptionConfig& config,
                                                        bus::DdsBus& bus) {
  if (config.velodyne_port == 0) return std::unique_ptr<VelodyneInput>();
  const bus::Topic points = sensor_topics(config.topics).front();
  bus.advertise(points);
  auto input = VelodyneInput::open(config.velodyne_port, [&bus, points](const sensor::Scan& scan) {
    bus.publish(points, ros_codec::encode(scan));
  });
  if (input) spdlog::info("UDP port {}: receives a Velodyne LiDAR for {}", config.velodyne_port, points.name);
  return input;
}

AgentId free_name(const std::string& wanted, const std::vector<AgentId>& robots) {
  AgentId name = *AgentId::parse(wanted);
  for (int k = 1; std::ranges::find(robots, name) != robots.end(); ++k)
    name = *AgentId::parse(wanted.substr(0, 2) + "-" + std::to_string(k));
  return name;
}

}  // namespace fleetmap::apps
