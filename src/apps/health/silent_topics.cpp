#include "silent_topics.hpp"

namespace fleetmap::apps {

std::vector<std::string> silent_topics(const agent::PerceptionConfig& config, const SensorSamples& heard) {
  std::vector<std::string> silent;
  const auto expect = [&](bool used, std::uint64_t samples, const std::string& topic, const std::string& key,
                          const std::string& type, const std::string& without) {
    if (!used || samples > 0) return;
    silent.push_back("no sample on " + topic + ": is its driver on, and does it publish " + type +
                     " under that name (" + key + ")? A robot without it has " + without);
  };
  const agent::SensorTopics& topics = config.topics;
  expect(config.odometry_uses_imu, heard.imu, topics.imu, "topics.imu", "sensor_msgs/msg/Imu",
         "odometry.use_imu: false");
  expect(config.uses_gps, heard.fixes, topics.fix, "topics.fix", "sensor_msgs/msg/NavSatFix",
         "gps.use: false");
  expect(config.odometry_uses_wheel, heard.wheel, topics.wheel, "topics.wheel", "nav_msgs/msg/Odometry",
         "odometry.use_wheel: false");
  return silent;
}

}  // namespace fleetmap::apps
