#include "sensor_listener.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "recordings/sample_player.hpp"
#include "silent_topics.hpp"

namespace fleetmap::apps {
SensorListener::SensorListener(const agent::PerceptionConfig& config, bus::Bus& bus)
    : config_(config), bus_(bus), check_({}, config), odometry_(config, bus, check_), mounts_(config) {
  subscriptions_.push_back(bus.subscribe(ros_codec::topics::tf_static(), [this](const Bytes& cdr) {
    const auto transforms = ros_codec::decode_transforms(cdr);
    if (!transforms) return void(++refused_["/tf_static: " + transforms.error().message]);
    mounts_.add(*transforms);
  }));
  const std::vector<bus::Topic> topics = sensor_topics(config.topics);
  subscriptions_.push_back(
      bus.subscribe(topics[0], [this, name = topics[0].name](const Bytes& cdr) { add_scan(cdr, name); }));
  listen<sensor::Imu>(topics[1]);
  listen<sensor::Fix>(topics[2]);
  listen<sensor::Wheel>(topics[3]);
}

std::vector<std::string> SensorListener::findings() {
  std::vector<std::string> all = check_.take_warnings();
  std::ranges::move(mounts_.take_warnings(), std::back_inserter(all));
  for (const auto& [what, count] : refused_)
    all.push_back(what + " (" + std::to_string(count) + " messages)");
  std::ranges::move(odometry_.failures(), std::back_inserter(all));
  return all;
}

std::vector<std::string> SensorListener::silent_topics() const {
  const auto heard = [&](std::size_t samples, const std::string& topic) {
    for (const auto& [what, count] : refused_) {
      if (what.starts_with(topic + ": ")) samples += count;
    }
    return samples;
  };
  std::vector<std::string> silent = apps::silent_topics(
      config_, {heard(streams_.imus(), config_.topics.imu), heard(streams_.fixes(), config_.topics.fix),
                heard(streams_.wheels(), config_.topics.wheel)});
  if (auto blind = streams_.fixes_without_place(config_.uses_gps)) silent.push_back(std::move(*blind));
  return silent;
}

template <class T>
void SensorListener::listen(const bus::Topic& topic) {
  subscriptions_.push_back(bus_.subscribe(
      topic, [this, name = topic.name](const Bytes& cdr) { add(ros_codec::decode<T>(cdr), cdr, name); }));
}

void SensorListener::add_scan(const Bytes& cdr, const std::string& topic) {
  auto decoded = ros_codec::decode_points(cdr, config_.topics.points_type);
  if (!decoded) return add<sensor::Scan>(tl::unexpected(std::move(decoded.error())), cdr, topic);
  if (auto finding = ros_codec::finding_of(decoded->time_unit); !finding.empty())
    check_.add_finding(std::move(finding));
  if (auto finding = lidar_frames_.add(ros_codec::frame_id_of(cdr).value_or("")))
    check_.add_finding(std::move(*finding));
  add<sensor::Scan>(std::move(decoded->scan), cdr, topic);
}

template <class T>
void SensorListener::add(Result<T> decoded, const Bytes& cdr, const std::string& topic) {
  if (!decoded) {
    ++refused_[topic + ": " + decoded.error().message];
    return;
  }
  recording::Sample sample(std::move(*decoded));
  streams_.add(sample);
  const auto source = static_cast<sensor::Source>(sample.index());
  if (source == sensor::Source::kGps && !config_.uses_gps) return;
  if (!place(source, ros_codec::frame_id_of(cdr).value_or(""))) return;
  if (check_.admit(sample, bus_.now())) odometry_.add(std::move(sample));
}

bool SensorListener::place(sensor::Source source, const std::string& frame_id) {
  const auto state = mounts_.on_message(source, frame_id, bus_.now());
  if (state != agent::SensorMounts::State::kDecided) return state == agent::SensorMounts::State::kKnown;
  mounts_.apply_to(config_, source);
  check_.set_mounts(config_);
  odometry_.set_mounts(config_);
  return true;
}

}  // namespace fleetmap::apps
