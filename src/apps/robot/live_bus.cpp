#include "live_bus.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "fleetmap/ros_codec/points_type.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {

Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config) {
  auto made = bus::DdsBus::create(config);
  if (!made) return made;
  for (const std::string& warning : (*made)->warnings()) spdlog::warn("{}: {}", config.agent.str(), warning);
  return made;
}

Result<LidarInput> publish_lidar(const agent::PerceptionConfig& config, bus::DdsBus& bus) {
  const std::vector<bus::Topic> topics = sensor_topics(config.topics);
  const auto publish_scan = [&bus, topics, type = config.topics.points_type](const sensor::Scan& scan) {
    bus.publish(topics[0], ros_codec::encode_points(scan, type));
  };
  LidarInput lidar;
  if (config.velodyne_port != 0) {
    bus.advertise(topics[0]);
    auto input = VelodyneInput::open(config.velodyne_port, publish_scan);
    if (!input) return tl::unexpected(input.error());
    lidar.velodyne = std::move(*input);
    spdlog::info("UDP port {}: receives a Velodyne LiDAR for {}", config.velodyne_port, topics[0].name);
  }
  if (config.ouster.lidar_port != 0) {
    bus.advertise(topics[0]);
    if (config.ouster.imu_port != 0) bus.advertise(topics[1]);
    const auto publish_imu = [&bus, topic = topics[1]](const sensor::Imu& sample) {
      bus.publish(topic, ros_codec::encode(sample));
    };
    auto input = OusterInput::open(config.ouster, {.on_scan = publish_scan, .on_imu = publish_imu});
    if (!input) return tl::unexpected(input.error());
    lidar.ouster = std::move(*input);
    spdlog::info("UDP port {}: receives {} for {}", config.ouster.lidar_port, config.ouster.metadata->device,
                 topics[0].name);
  }
  return lidar;
}

AgentId free_name(const std::string& wanted, const std::vector<AgentId>& robots) {
  AgentId name = *AgentId::parse(wanted);
  for (int k = 1; std::ranges::find(robots, name) != robots.end(); ++k)
    name = *AgentId::parse(wanted.substr(0, 2) + "-" + std::to_string(k));
  return name;
}

}  // namespace fleetmap::apps
