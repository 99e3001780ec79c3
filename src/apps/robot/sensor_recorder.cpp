#include "sensor_recorder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {
namespace {

std::filesystem::path free_folder(const std::filesystem::path& directory) {
  std::filesystem::path folder = directory;
  for (int k = 1; is_there(folder); ++k) folder = directory.string() + "-" + std::to_string(k);
  return folder;
}

}  // namespace

recording::Durability durability_of(const bus::Topic& topic) {
  return topic.profile == "latched" ? recording::Durability::kTransientLocal
                                    : recording::Durability::kVolatile;
}

SensorRecorder::SensorRecorder(recording::BagWriter writer, const agent::SensorTopics& topics, bool outputs,
                               bus::Bus& bus)
    : writer_(std::move(writer)) {
  std::vector<bus::Topic> recorded = sensor_topics(topics);
  recorded.push_back(ros_codec::topics::tf_static());
  for (const bus::Topic& output : outputs ? ros_codec::topics::outputs() : std::vector<bus::Topic>()) {
    if (std::ranges::find(recorded, output.name, &bus::Topic::name) == recorded.end())
      recorded.push_back(output);
  }
  for (const bus::Topic& topic : recorded) {
    subscriptions_.push_back(bus.subscribe(topic, [this, topic, &bus](const Bytes& cdr) {
      if (failed_) return;
      const Status written = writer_.write(topic.name, topic.type, bus.now(), cdr, durability_of(topic));
      failed_ = !written;
      if (failed_) spdlog::error("recording stopped: {}", written.error().message);
    }));
  }
}

Result<std::unique_ptr<SensorRecorder>> SensorRecorder::create(const RecordOptions& options,
                                                               const agent::SensorTopics& topics,
                                                               bool outputs, bus::Bus& bus) {
  auto writer = recording::BagWriter::create(free_folder(options.folder), options.format);
  if (!writer) return tl::unexpected(writer.error());
  return std::unique_ptr<SensorRecorder>(new SensorRecorder(std::move(*writer), topics, outputs, bus));
}

Status SensorRecorder::close() {
  subscriptions_.clear();
  return writer_.close();
}

}  // namespace fleetmap::apps
