#include "sensor_listener.hpp"

#include <utility>

#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "sample_player.hpp"

namespace fleetmap::apps {

SensorListener::SensorListener(const agent::PerceptionConfig& config, bus::Bus& bus)
    : bus_(bus), check_({}, config.odometry.T_base_lidar) {
  const std::vector<bus::Topic> topics = sensor_topics(config.topics);
  subscriptions_.push_back(bus.subscribe(topics[0], [this, name = topics[0].name](const Bytes& cdr) {
    add(ros_codec::decode<sensor::Scan>(cdr), name);
  }));
  listen<sensor::Imu>(topics[1]);
  listen<sensor::Fix>(topics[2]);
  listen<sensor::Wheel>(topics[3]);
}

std::vector<std::string> SensorListener::findings() {
  std::vector<std::string> all = check_.take_warnings();
  for (const auto& [what, count] : refused_)
    all.push_back(what + " (" + std::to_string(count) + " messages)");
  return all;
}

template <class T>
void SensorListener::listen(const bus::Topic& topic) {
  subscriptions_.push_back(bus_.subscribe(
      topic, [this, name = topic.name](const Bytes& cdr) { add(ros_codec::decode<T>(cdr), name); }));
}

template <class T>
void SensorListener::add(Result<T> decoded, const std::string& topic) {
  if (!decoded) {
    ++refused_[topic + ": " + decoded.error().message];
    return;
  }
  recording::Sample sample(std::move(*decoded));
  streams_.add(sample);
  check_.admit(sample, bus_.now());
}

}  // namespace fleetmap::apps
